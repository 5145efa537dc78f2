// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/test_model.hpp"

#include "host_tools/mesh/read_mesh.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "tests/shared/temporary_folder.hpp"

#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <utility>

namespace tactus::test
{

namespace
{

[[noreturn]] void give_up(const std::string& name, const std::string& reason)
{
    std::fprintf(stderr, "test model %s: %s\n", name.c_str(), reason.c_str());
    std::exit(2);
}

void scale_errors(Simplification& simplified, double scale)
{
    const auto factor = static_cast<float>(scale);
    for (Collapse& collapse : simplified.collapses)
    {
        for (float& error : collapse.error)
        {
            error *= factor;
        }
    }
    for (float& error : simplified.base_error)
    {
        error *= factor;
    }
}

const TestModel& kept_model(const std::string& name, const TriangleMesh& mesh,
                            std::uint32_t base_faces, double error_scale)
{
    static std::map<std::string, std::unique_ptr<TestModel>> models;
    std::unique_ptr<TestModel>& model = models[name];
    if (!model)
    {
        const MadeModel made = make_model(name, mesh, base_faces, kMinPositionBits, error_scale);
        model = std::make_unique<TestModel>(TestModel{name, made.path, faces_on_grid(made.prepared),
                                                      made.prepared.diagonal_m, base_faces,
                                                      made.prepared.origin_m});
    }
    return *model;
}

/// Loose triangles and small closed solids, most of which do not fit in the base mesh.
TriangleMesh make_crumbs()
{
    TriangleMesh crumbs = make_triangle_soup(400, 9).value();
    const TriangleMesh solid = make_uv_sphere(2, 4).value();
    for (std::uint32_t i = 0; i < 60; ++i)
    {
        const auto first = static_cast<std::uint32_t>(crumbs.positions.size());
        const std::array<double, 3> middle = crumbs.positions[3 * std::size_t{i}];
        for (std::array<double, 3> position : solid.positions)
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                position[axis] = middle[axis] + 0.05 * position[axis];
            }
            crumbs.positions.push_back(position);
        }
        for (const auto& [a, b, c] : solid.faces)
        {
            crumbs.faces.push_back({first + a, first + b, first + c});
        }
    }
    return crumbs;
}

const TestModel& shape_model(Shape shape, std::uint32_t faces)
{
    const std::string name(shape_names()[static_cast<std::size_t>(shape)]);
    return test_model(name, make_shape(shape, faces).value());
}

} // namespace

MadeModel make_model(std::string name, const TriangleMesh& mesh, std::uint32_t base_faces,
                     std::uint32_t position_bits, double error_scale)
{
    PrepareOptions preparing;
    preparing.position_bits = position_bits;
    auto prepared = prepare_mesh(mesh, preparing);
    if (!prepared)
    {
        give_up(name, prepared.error().text);
    }
    SimplifyOptions simplifying;
    simplifying.base_faces = base_faces;
    auto simplified = simplify(prepared.value().mesh, simplifying);
    if (!simplified)
    {
        give_up(name, simplified.error().text);
    }
    scale_errors(simplified.value(), error_scale);
    return make_model(std::move(name), std::move(prepared).value(), std::move(simplified).value(),
                      {position_bits, base_faces, std::nullopt});
}

MadeModel make_model(std::string name, PreparedMesh prepared, Simplification simplification,
                     const EncodeOptions& options)
{
    static const TemporaryFolder folder("models");
    MadeModel model{std::move(name), {}, std::move(prepared), std::move(simplification), {}};
    model.path = folder.path() / (model.name + ".spm");
    if (std::filesystem::exists(model.path))
    {
        model.path.replace_extension("." + std::to_string(folder.files()) + ".spm");
    }
    const auto written = write_spm(model.path, model.prepared, model.simplification, options);
    if (!written)
    {
        give_up(model.name, written.error().text);
    }
    model.fields = written.value();
    return model;
}

std::vector<Face> faces_on_grid(const PreparedMesh& prepared)
{
    const auto quantum = static_cast<float>(prepared.quantum_m);
    std::vector<Face> faces;
    faces.reserve(prepared.mesh.faces.size());
    for (const auto& corners : prepared.mesh.faces)
    {
        Face& face = faces.emplace_back();
        for (std::size_t i = 0; i < 3; ++i)
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                const std::int32_t place = prepared.mesh.positions[corners[i]][axis];
                face[i][axis] = static_cast<float>(place) * quantum;
            }
        }
    }
    return faces;
}

TriangleMesh scaled_mesh(TriangleMesh mesh, double factor)
{
    for (auto& corner : mesh.positions)
    {
        for (double& coordinate : corner)
        {
            coordinate *= factor;
        }
    }
    return mesh;
}

const TestModel& test_model(const std::string& name, const TriangleMesh& mesh,
                            std::uint32_t base_faces)
{
    return kept_model(name, mesh, base_faces, 1.0);
}

const TestModel& lying_model(const std::string& name, const TriangleMesh& mesh, double error_scale)
{
    return kept_model(name, mesh, 200, error_scale);
}

const TestModel& small_model(std::size_t index)
{
    switch (index)
    {
    case 0:
        return shape_model(Shape::bumpy_sphere, 4'000);
    case 1:
        return shape_model(Shape::torus, 3'000);
    case 2:
        return shape_model(Shape::terrain, 3'000);
    case 3:
        return shape_model(Shape::gear, 3'000);
    case 4:
        return test_model("thin-plate", make_thin_plate(25, 2e-5).value());
    case 5:
        return test_model("needles", make_uv_sphere(10, 200).value());
    case 6:
        return test_model("crumbs", make_crumbs());
    default:
        give_up("small", "there is no such one");
    }
}

std::vector<const TestModel*> small_models()
{
    std::vector<const TestModel*> models;
    for (std::size_t i = 0; i < kSmallModels; ++i)
    {
        models.push_back(&small_model(i));
    }
    return models;
}

std::optional<TriangleMesh> read_known(const KnownMesh& mesh)
{
    const char* folder = std::getenv("TACTUS_MESHES");
    if (folder == nullptr)
    {
        return std::nullopt;
    }
    auto read = read_mesh(std::filesystem::path(folder) / mesh.file);
    if (!read)
    {
        give_up(mesh.name, read.error().text);
    }
    return std::move(read).value();
}

const TestModel* known_model(const KnownMesh& mesh)
{
    const auto read = read_known(mesh);
    return read ? &test_model(mesh.name, *read, 500) : nullptr;
}

} // namespace tactus::test
