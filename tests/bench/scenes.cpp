// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/scenes.hpp"

#include "host_tools/cli/progress.hpp"
#include "host_tools/encode/write_spm.hpp"
#include "host_tools/mesh/prepare.hpp"
#include "host_tools/mesh/read_mesh.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "tests/bench/mesh_refinement.hpp"
#include "tests/bench/random.hpp"
#include "transport/content_hash.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <span>
#include <thread>

namespace tactus::bench
{

namespace
{

constexpr std::uint32_t kBaseFaces = 500;

test::TestModel described(const std::string& name, const PreparedMesh& prepared)
{
    test::TestModel model;
    model.name = name;
    model.diagonal_m = prepared.diagonal_m;
    model.origin_m = prepared.origin_m;
    model.faces = test::faces_on_grid(prepared);
    model.base_faces = kBaseFaces;
    return model;
}

/// Everything that an encoded file depends on: the mesh on its grid and the encoder.
std::string encoded_name(const std::string& name, const PreparedMesh& prepared)
{
    const ContentHash positions = content_hash(std::as_bytes(std::span(prepared.mesh.positions)));
    const ContentHash faces = content_hash(std::as_bytes(std::span(prepared.mesh.faces)));
    const std::string all = fmt::format("{} {} {:a} {} {}", hash_text(positions), hash_text(faces),
                                        prepared.quantum_m, kBaseFaces, TACTUS_ENCODER_SOURCES);
    return name + '-' + hash_text(content_hash(std::as_bytes(std::span(all)))) + ".spm";
}

std::optional<SceneError> encode(const test::TestModel& model, const PreparedMesh& prepared)
{
    Progress progress("encode " + model.name, "faces");
    SimplifyOptions options;
    options.base_faces = kBaseFaces;
    options.threads = std::max(1U, std::thread::hardware_concurrency());
    options.progress = [&](std::size_t left, std::size_t total)
    {
        progress.update(total - left, total);
        return true;
    };
    const auto simplified = simplify(prepared.mesh, options);
    if (!simplified)
    {
        return SceneError{model.name + ": " + simplified.error().text};
    }
    EncodeOptions encode_options;
    encode_options.base_faces = kBaseFaces;
    encode_options.threads = options.threads;
    const auto written = write_spm(model.path, prepared, simplified.value(), encode_options);
    return written ? std::nullopt : std::optional(SceneError{written.error().text});
}

} // namespace

Result<NamedMesh, SceneError> source_mesh(const SceneSource& source)
{
    const char* folder = std::getenv("TACTUS_MESHES");
    if (source.mesh_file == nullptr || folder == nullptr)
    {
        return NamedMesh{fmt::format("bumpy-sphere-{}", source.stand_in_faces),
                         make_shape(Shape::bumpy_sphere, source.stand_in_faces).value()};
    }
    auto mesh = read_mesh(std::filesystem::path(folder) / source.mesh_file);
    if (!mesh)
    {
        return SceneError{"TACTUS_MESHES: " + mesh.error().text};
    }
    TriangleMesh fine = std::move(mesh).value();
    for (std::uint32_t i = 0; i < source.subdivisions; ++i)
    {
        fine = subdivided(fine);
    }
    if (source.subdivisions > 0)
    {
        fine = with_normal_noise(fine, kNoiseShare, kSeed);
    }
    return NamedMesh{source.name, std::move(fine)};
}

SceneStore::SceneStore(std::filesystem::path cache) : folder_(std::move(cache))
{
    if (folder_.empty())
    {
        folder_ = own_folder_.emplace("bench").path();
    }
}

Result<const Scene*, SceneError> SceneStore::get(const SceneSource& source)
{
    std::unique_ptr<Scene>& scene = scenes_[source.name];
    if (scene)
    {
        return scene.get();
    }
    const auto named = source_mesh(source);
    if (!named)
    {
        return named.error();
    }
    const auto prepared = prepare_mesh(named.value().mesh, {});
    if (!prepared)
    {
        return SceneError{named.value().name + ": " + prepared.error().text};
    }
    auto made = std::make_unique<Scene>();
    made->model = described(named.value().name, prepared.value());
    made->model.path = folder_ / encoded_name(made->model.name, prepared.value());
    if (!std::filesystem::exists(made->model.path))
    {
        if (const auto failure = encode(made->model, prepared.value()))
        {
            return *failure;
        }
    }
    made->tree = std::make_unique<test::FaceTree>(made->model.faces);
    scene = std::move(made);
    return scene.get();
}

} // namespace tactus::bench
