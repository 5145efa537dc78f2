// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/scenes.hpp"

#include "host_tools/cli/progress.hpp"
#include "host_tools/encode/decoded_model.hpp"
#include "host_tools/encode/extract.hpp"
#include "host_tools/encode/write_spm.hpp"
#include "host_tools/mesh/prepare.hpp"
#include "host_tools/mesh/read_mesh.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "tests/bench/mesh_refinement.hpp"
#include "tests/bench/random.hpp"
#include "transport/content_hash.hpp"
#include "transport/store/model_store.hpp"

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

std::optional<SceneError> encode(const test::TestModel& model, const PreparedMesh& prepared,
                                 std::uint32_t position_bits)
{
    Progress progress("tactus_bench", "encode " + model.name, "faces");
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
    encode_options.position_bits = position_bits;
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

Result<NamedMesh, SceneError> coarser_mesh(const std::string& name, const test::TestModel& model,
                                           std::uint32_t faces)
{
    const auto store = ModelStore::open(model.path);
    if (!store)
    {
        return SceneError{store.error().text};
    }
    std::vector<std::string> damage;
    const DecodedModel decoded = DecodedModel::decode(store.value(), damage);
    if (!damage.empty())
    {
        return SceneError{damage.front()};
    }
    return NamedMesh{name, extract(decoded, {faces, {}, {}}).mesh};
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
    if (const auto found = scenes_.find(source.name); found != scenes_.end())
    {
        return found->second.get();
    }
    const auto named = source_mesh(source);
    if (!named)
    {
        return named.error();
    }
    auto made = make(named.value(), kMinPositionBits);
    if (!made)
    {
        return made.error();
    }
    return (scenes_[source.name] = std::move(made).value()).get();
}

Result<const Scene*, SceneError> SceneStore::get(const NamedMesh& named,
                                                 std::uint32_t position_bits)
{
    if (const auto found = scenes_.find(named.name); found != scenes_.end())
    {
        return found->second.get();
    }
    auto made = make(named, position_bits);
    if (!made)
    {
        return made.error();
    }
    return (scenes_[named.name] = std::move(made).value()).get();
}

Result<std::unique_ptr<Scene>, SceneError> SceneStore::make(const NamedMesh& named,
                                                            std::uint32_t position_bits) const
{
    PrepareOptions options;
    options.position_bits = position_bits;
    const auto prepared = prepare_mesh(named.mesh, options);
    if (!prepared)
    {
        return SceneError{named.name + ": " + prepared.error().text};
    }
    auto made = std::make_unique<Scene>();
    made->model = described(named.name, prepared.value());
    made->model.path = folder_ / encoded_name(made->model.name, prepared.value());
    if (!std::filesystem::exists(made->model.path))
    {
        if (const auto failure = encode(made->model, prepared.value(), position_bits))
        {
            return *failure;
        }
    }
    made->tree = std::make_unique<test::FaceTree>(made->model.faces);
    return made;
}

} // namespace tactus::bench
