// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/scenes.hpp"

#include "host_tools/encode/extract.hpp"
#include "host_tools/encode/write_spm.hpp"
#include "host_tools/mesh/prepare.hpp"
#include "host_tools/mesh/read_mesh.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "platform/program/progress.hpp"
#include "tests/bench/bench_row.hpp"
#include "tests/bench/mesh_refinement.hpp"
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

/// Name from all inputs of an encoded file: the mesh on its grid and the encoder.
std::string encoded_name(const std::string& name, const PreparedMesh& prepared)
{
    const ContentHash positions = content_hash(std::as_bytes(std::span(prepared.mesh.positions)));
    const ContentHash faces = content_hash(std::as_bytes(std::span(prepared.mesh.faces)));
    const std::string all = fmt::format("{} {} {:a} {} {}", hash_text(positions), hash_text(faces),
                                        prepared.quantum_m, kBaseFaces, TACTUS_ENCODER_SOURCES);
    return name + '-' + hash_text(content_hash(std::as_bytes(std::span(all)))) + ".spm";
}

void encode(const test::TestModel& model, const PreparedMesh& prepared, std::uint32_t position_bits)
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
    const auto simplified = needed(simplify(prepared.mesh, options));
    EncodeOptions encode_options;
    encode_options.position_bits = position_bits;
    encode_options.base_faces = kBaseFaces;
    encode_options.threads = options.threads;
    needed(write_spm(model.path, prepared, simplified, encode_options));
}

} // namespace

TriangleMesh scaled(TriangleMesh mesh, double scale)
{
    for (auto& position : mesh.positions)
    {
        std::ranges::transform(position, position.begin(), [scale](double x) { return scale * x; });
    }
    return mesh;
}

std::vector<test::Face> faces_of(const TriangleMesh& mesh, const std::array<double, 3>& origin)
{
    std::vector<test::Face> faces;
    faces.reserve(mesh.faces.size());
    for (const auto& corners : mesh.faces)
    {
        test::Face& face = faces.emplace_back();
        for (std::size_t i = 0; i < 3; ++i)
        {
            std::ranges::transform(mesh.positions[corners[i]], origin, face[i].begin(),
                                   [](double x, double from)
                                   { return static_cast<float>(x - from); });
        }
    }
    return faces;
}

NamedMesh source_mesh(const SceneSource& source)
{
    const char* folder = std::getenv("TACTUS_MESHES");
    if (source.mesh_file == nullptr || folder == nullptr)
    {
        return NamedMesh{fmt::format("bumpy-sphere-{}", source.stand_in_faces),
                         make_shape(Shape::bumpy_sphere, source.stand_in_faces).value()};
    }
    TriangleMesh fine = needed(read_mesh(std::filesystem::path(folder) / source.mesh_file));
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

DecodedModel decode_all(const ModelStore& store)
{
    std::vector<std::string> damage;
    DecodedModel model = DecodedModel::decode(store, damage);
    if (!damage.empty())
    {
        throw Failure(damage.front());
    }
    return model;
}

NamedMesh coarser_mesh(const std::string& name, const test::TestModel& model, std::uint32_t faces)
{
    return {name, extract(decode_all(needed(ModelStore::open(model.path))), {faces, {}, {}}).mesh};
}

SceneStore::SceneStore(std::filesystem::path cache) : folder_(std::move(cache))
{
    if (folder_.empty())
    {
        folder_ = own_folder_.emplace("bench").path();
    }
}

const Scene& SceneStore::get(const SceneSource& source)
{
    std::unique_ptr<Scene>& scene = scenes_[source.name];
    if (scene == nullptr)
    {
        scene = make(source_mesh(source), kMinPositionBits);
    }
    return *scene;
}

const Scene& SceneStore::get(const NamedMesh& named, std::uint32_t position_bits)
{
    std::unique_ptr<Scene>& scene = scenes_[named.name];
    if (scene == nullptr)
    {
        scene = make(named, position_bits);
    }
    return *scene;
}

std::unique_ptr<Scene> SceneStore::make(const NamedMesh& named, std::uint32_t position_bits) const
{
    PrepareOptions options;
    options.position_bits = position_bits;
    const auto prepared = needed(prepare_mesh(named.mesh, options));
    auto made = std::make_unique<Scene>();
    made->model = described(named.name, prepared);
    made->model.path = folder_ / encoded_name(made->model.name, prepared);
    if (!std::filesystem::exists(made->model.path))
    {
        encode(made->model, prepared, position_bits);
    }
    made->tree = std::make_unique<test::FaceTree>(made->model.faces);
    return made;
}

} // namespace tactus::bench
