// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/host_encode/sample_meshes.hpp"

#include "host_tools/mesh/read_mesh.hpp"

#include <cstdlib>
#include <stdexcept>

namespace tactus
{

namespace
{

template <Shape shape, std::uint32_t faces>
TriangleMesh shaped()
{
    return make_shape(shape, faces).value();
}

} // namespace

std::unique_ptr<EncodedModel> SampleMesh::encode() const
{
    if (file == nullptr)
    {
        return encode_source(name, make(), base_faces);
    }
    const char* folder = std::getenv("TACTUS_MESHES");
    if (folder == nullptr)
    {
        return nullptr;
    }
    const auto mesh = read_mesh(std::filesystem::path(folder) / file);
    if (!mesh)
    {
        throw std::runtime_error(mesh.error().text);
    }
    return encode_source(name, mesh.value(), base_faces);
}

std::vector<SampleMesh> generated_meshes()
{
    return {{"bumpy_sphere", nullptr, shaped<Shape::bumpy_sphere, 20'000>, 100},
            {"torus", nullptr, shaped<Shape::torus, 3'000>, 100},
            {"terrain", nullptr, shaped<Shape::terrain, 3'000>, 100},
            {"gear", nullptr, shaped<Shape::gear, 3'000>, 100},
            {"thin_plate", nullptr, [] { return make_thin_plate(25, 2e-5).value(); }, 60},
            {"needles", nullptr, [] { return make_uv_sphere(10, 200).value(); }, 100}};
}

std::vector<SampleMesh> known_meshes()
{
    std::vector<SampleMesh> meshes = smaller_known_meshes();
    meshes.push_back({"igea", "igea.ply", nullptr, 500});
    return meshes;
}

std::vector<SampleMesh> smaller_known_meshes()
{
    return {{"cow", "cow.obj", nullptr, 100},
            {"teapot", "teapot.obj", nullptr, 100},
            {"fandisk", "fandisk.obj", nullptr, 100},
            {"bunny", "stanford-bunny.obj", nullptr, 500}};
}

} // namespace tactus
