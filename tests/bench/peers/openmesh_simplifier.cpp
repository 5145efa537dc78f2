// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/measuring.hpp"
#include "tests/bench/peers/all_peers.hpp"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <stdexcept>

namespace tactus::bench
{

namespace
{

using OpenTriangles = OpenMesh::TriMesh_ArrayKernelT<>;

OpenTriangles to_openmesh(const QuantisedMesh& mesh)
{
    OpenTriangles made;
    made.request_face_status();
    made.request_edge_status();
    made.request_vertex_status();
    for (const auto& [x, y, z] : mesh.positions)
    {
        made.add_vertex(OpenTriangles::Point(static_cast<float>(x), static_cast<float>(y),
                                             static_cast<float>(z)));
    }
    for (const auto& corners : mesh.faces)
    {
        const auto vertex = [&](std::size_t i)
        { return OpenMesh::VertexHandle(static_cast<int>(corners[i])); };
        if (!made.add_face(vertex(0), vertex(1), vertex(2)).is_valid())
        {
            throw std::runtime_error("OpenMesh: refuses a face");
        }
    }
    return made;
}

TriangleMesh from_openmesh(const OpenTriangles& from)
{
    TriangleMesh mesh;
    for (const auto vertex : from.vertices())
    {
        const OpenTriangles::Point& point = from.point(vertex);
        mesh.positions.push_back({static_cast<double>(point[0]), static_cast<double>(point[1]),
                                  static_cast<double>(point[2])});
    }
    for (const auto face : from.faces())
    {
        std::size_t corner = 0;
        std::array<std::uint32_t, 3>& corners = mesh.faces.emplace_back();
        for (const auto vertex : from.fv_range(face))
        {
            corners[corner++] = static_cast<std::uint32_t>(vertex.idx());
        }
    }
    return mesh;
}

} // namespace

SimplifiedMesh simplify_by_openmesh(const QuantisedMesh& mesh, std::uint32_t faces)
{
    OpenTriangles triangles = to_openmesh(mesh);
    const BenchClock::time_point start = BenchClock::now();
    OpenMesh::Decimater::DecimaterT<OpenTriangles> decimater(triangles);
    OpenMesh::Decimater::ModQuadricT<OpenTriangles>::Handle quadric;
    decimater.add(quadric);
    decimater.module(quadric).unset_max_err();
    if (!decimater.initialize())
    {
        throw std::runtime_error("OpenMesh: the decimater refuses the mesh");
    }
    decimater.decimate_to_faces(0, faces);
    triangles.garbage_collection();
    const BenchClock::time_point end = BenchClock::now();
    return {from_openmesh(triangles), seconds(start, end)};
}

} // namespace tactus::bench
