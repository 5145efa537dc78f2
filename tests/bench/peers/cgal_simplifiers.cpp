// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/measuring.hpp"
#include "tests/bench/peers/all_peers.hpp"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <stdexcept>

namespace tactus::bench
{

namespace
{

namespace sms = CGAL::Surface_mesh_simplification;
using Kernel = CGAL::Simple_cartesian<double>;
using CgalMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Quadrics = sms::GarlandHeckbert_plane_policies<CgalMesh, Kernel>;

/// CGAL's own stop predicates count edges.
struct StopAtFaces
{
    std::uint32_t wanted;

    template <typename Cost, typename Profile>
    bool operator()(const Cost& /*cost*/, const Profile& profile, std::size_t /*initial_edges*/,
                    std::size_t /*current_edges*/) const
    {
        return profile.surface_mesh().number_of_faces() <= wanted;
    }
};

CgalMesh to_cgal(const QuantisedMesh& mesh)
{
    CgalMesh made;
    for (const auto& [x, y, z] : mesh.positions)
    {
        made.add_vertex(Kernel::Point_3(x, y, z));
    }
    for (const auto& [a, b, c] : mesh.faces)
    {
        using Vertex = CgalMesh::Vertex_index;
        if (made.add_face(Vertex(a), Vertex(b), Vertex(c)) == CgalMesh::null_face())
        {
            throw std::runtime_error("CGAL: refuses a face");
        }
    }
    return made;
}

TriangleMesh from_cgal(const CgalMesh& from)
{
    TriangleMesh mesh;
    for (std::uint32_t v = 0; v < from.num_vertices(); ++v)
    {
        const Kernel::Point_3& point = from.point(CgalMesh::Vertex_index(v));
        mesh.positions.push_back({point.x(), point.y(), point.z()});
    }
    for (const CgalMesh::Face_index face : from.faces())
    {
        std::size_t corner = 0;
        std::array<std::uint32_t, 3>& corners = mesh.faces.emplace_back();
        for (const CgalMesh::Vertex_index v : from.vertices_around_face(from.halfedge(face)))
        {
            corners[corner++] = v.idx();
        }
    }
    return mesh;
}

/// Simplifies by `collapse(mesh, stop)`, the only call that is timed.
template <typename Collapse>
SimplifiedMesh simplify(const QuantisedMesh& from, std::uint32_t faces, const Collapse& collapse)
{
    CgalMesh mesh = to_cgal(from);
    const BenchClock::time_point start = BenchClock::now();
    collapse(mesh, StopAtFaces{faces});
    const BenchClock::time_point end = BenchClock::now();
    return {from_cgal(mesh), seconds(start, end)};
}

} // namespace

SimplifiedMesh simplify_by_garland_heckbert(const QuantisedMesh& mesh, std::uint32_t faces)
{
    return simplify(mesh, faces,
                    [](CgalMesh& cgal, const StopAtFaces& stop)
                    {
                        const Quadrics quadrics(cgal);
                        sms::edge_collapse(cgal, stop,
                                           CGAL::parameters::get_cost(quadrics.get_cost())
                                               .get_placement(quadrics.get_placement()));
                    });
}

SimplifiedMesh simplify_by_bounded_garland_heckbert(const QuantisedMesh& mesh, std::uint32_t faces)
{
    return simplify(
        mesh, faces,
        [](CgalMesh& cgal, const StopAtFaces& stop)
        {
            const Quadrics quadrics(cgal);
            const sms::Bounded_normal_change_placement<Quadrics::Get_placement> placement(
                quadrics.get_placement());
            sms::edge_collapse(
                cgal, stop,
                CGAL::parameters::get_cost(quadrics.get_cost()).get_placement(placement));
        });
}

SimplifiedMesh simplify_by_lindstrom_turk(const QuantisedMesh& mesh, std::uint32_t faces)
{
    return simplify(mesh, faces,
                    [](CgalMesh& cgal, const StopAtFaces& stop)
                    {
                        sms::edge_collapse(
                            cgal, stop,
                            CGAL::parameters::get_cost(sms::LindstromTurk_cost<CgalMesh>())
                                .get_placement(sms::LindstromTurk_placement<CgalMesh>()));
                    });
}

} // namespace tactus::bench
