// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

#include "tests/bench/scenes.hpp"

#include "host_tools/encode/extract.hpp"
#include "host_tools/encode/write_spm.hpp"
#include "host_tools/mesh/prepare.hpp"
#include "host_tools/mesh/read_mesh.hpp"
#include "host_tools/mesh/triangle_mesh.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "platform/program/progress.hpp"
#include "tests/bench/bench_row.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/surface_slide.hpp"
#include "transport/content_hash.hpp"
#include "transport/store/model_store.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <thread>
#include <unordered_map>

namespace tactus::bench
{
namespace
{

constexpr double kTurn_rad_per_s = 3.0;
constexpr double kFlight_diag = 0.62;
constexpr double kFlight_diag_per_s = 2.0;
constexpr double kTouch_diag_per_s = 0.1;

double smoothstep(double t)
{
    return t * t * (3.0 - 2.0 * t);
}

/// Straight motion to `to` with a smooth start and end.
void move(std::vector<Vec3>& path, const Vec3& from, const Vec3& to, std::uint32_t frames)
{
    for (std::uint32_t i = 1; i <= frames; ++i)
    {
        path.emplace_back(from + smoothstep(static_cast<double>(i) / frames) * (to - from));
    }
}

/// Start of a slide that is reached from `from`.
Vec3 slide_start(const TouchScene& scene, const Vec3& from)
{
    const test::FaceTree::Nearest nearest = scene.tree.nearest(from);
    const Vec3 normal = (from - nearest.point_m).normalized();
    return nearest.point_m +
           test::SurfaceSlide::wanted_distance_diag(kRadius_diag, 0) * scene.diagonal_m * normal;
}

void slide(std::vector<Vec3>& path, const TouchScene& scene, double speed_diag_per_s,
           std::uint32_t frames)
{
    test::SlideManner manner;
    manner.diagonal_m = scene.diagonal_m;
    manner.radius_diag = kRadius_diag;
    manner.step_m = speed_diag_per_s * scene.diagonal_m * kPeriod_s;
    manner.rotation_rad = kTurn_rad_per_s * kPeriod_s;
    manner.rotation_rate = [](std::uint64_t turn) { return test::signed_unit(kSeed, turn); };
    test::SurfaceSlide slide(scene.tree, manner, path.back());
    for (std::uint32_t i = 0; i < frames; ++i)
    {
        path.push_back(slide.next());
    }
}

void fly(std::vector<Vec3>& path, const TouchScene& scene, const Vec3& middle, std::uint64_t cycle)
{
    const double radius_m = kFlight_diag * scene.diagonal_m;
    Vec3 outward = (path.back() - middle).normalized();
    const Vec3 request(test::signed_unit(kSeed + 1, 3 * cycle),
                       test::signed_unit(kSeed + 1, 3 * cycle + 1),
                       test::signed_unit(kSeed + 1, 3 * cycle + 2));
    Vec3 heading = test::tangent(request, outward);
    for (std::uint32_t i = 0; i < kFlightFrames; ++i)
    {
        outward = (outward + kFlight_diag_per_s * kPeriod_s / kFlight_diag * heading).normalized();
        heading = test::tangent(heading, outward);
        path.emplace_back(middle + radius_m * outward);
    }
}

} // namespace

std::vector<Vec3> slide_motion(const TouchScene& scene, double speed_diag_per_s,
                               std::uint32_t frames)
{
    const Vec3 middle = 0.5 * (scene.tree.low_m() + scene.tree.high_m());
    const Vec3 above(middle.x(), middle.y(), scene.tree.high_m().z() + 0.05 * scene.diagonal_m);
    std::vector<Vec3> path;
    move(path, above, slide_start(scene, above), kApproachFrames);
    slide(path, scene, speed_diag_per_s, frames);
    return path;
}

std::vector<Vec3> touch_motion(const TouchScene& scene, std::uint32_t frames)
{
    const Vec3 middle = 0.5 * (scene.tree.low_m() + scene.tree.high_m());
    const double flight_m = kFlight_diag * scene.diagonal_m;
    std::vector<Vec3> path{middle + Vec3(0.0, 0.0, flight_m)};
    for (std::uint64_t cycle = 0; path.size() <= frames; ++cycle)
    {
        fly(path, scene, middle, cycle);
        const Vec3 above = path.back();
        move(path, above, slide_start(scene, above), kApproachFrames);
        slide(path, scene, kTouch_diag_per_s, kTouchFrames);
        const Vec3 below = path.back();
        move(path, below, middle + flight_m * (below - middle).normalized(), kRetreatFrames);
    }
    return {path.begin() + 1, path.begin() + 1 + frames};
}

namespace
{

Eigen::Vector3d position(const TriangleMesh& mesh, std::uint32_t vertex)
{
    const std::array<double, 3>& place = mesh.positions[vertex];
    return {place[0], place[1], place[2]};
}

/// Averages over a vertex's faces.
struct Vicinity
{
    Eigen::Vector3d normal{0.0, 0.0, 0.0};
    double edge_length_sum{0.0};
    std::uint32_t edges{0};
};

std::vector<Vicinity> vicinities(const TriangleMesh& mesh)
{
    std::vector<Vicinity> all(mesh.positions.size());
    for (const auto& face : mesh.faces)
    {
        for (std::size_t i = 0; i < 3; ++i)
        {
            const Eigen::Vector3d here = position(mesh, face[i]);
            const Eigen::Vector3d next = position(mesh, face[(i + 1) % 3]) - here;
            const Eigen::Vector3d last = position(mesh, face[(i + 2) % 3]) - here;
            Vicinity& vicinity = all[face[i]];
            vicinity.normal += next.cross(last);
            vicinity.edge_length_sum += next.norm() + last.norm();
            vicinity.edges += 2;
        }
    }
    return all;
}

/// Splits each face into four at its edge midpoints; faces with a common edge share its midpoint.
TriangleMesh subdivided(const TriangleMesh& mesh)
{
    TriangleMesh fine{mesh.positions, {}};
    fine.faces.reserve(4 * mesh.faces.size());
    std::unordered_map<std::uint64_t, std::uint32_t> midpoints;
    midpoints.reserve(2 * mesh.faces.size());
    const auto midpoint = [&](std::uint32_t a, std::uint32_t b)
    {
        const std::uint64_t edge = (std::uint64_t{std::min(a, b)} << 32U) | std::max(a, b);
        const auto [found, is_new] =
            midpoints.try_emplace(edge, static_cast<std::uint32_t>(fine.positions.size()));
        if (is_new)
        {
            const Eigen::Vector3d middle = 0.5 * (position(mesh, a) + position(mesh, b));
            fine.positions.push_back({middle.x(), middle.y(), middle.z()});
        }
        return found->second;
    };
    for (const auto& [a, b, c] : mesh.faces)
    {
        const std::uint32_t ab = midpoint(a, b);
        const std::uint32_t bc = midpoint(b, c);
        const std::uint32_t ca = midpoint(c, a);
        fine.faces.insert(fine.faces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    return fine;
}

/// Moves each vertex along its normal (area-weighted mean of its faces) by a uniform share in
/// -`share` .. +`share` of the mean length of its faces' edges there.
TriangleMesh with_normal_noise(const TriangleMesh& mesh, double share, std::uint64_t seed)
{
    TriangleMesh noisy = mesh;
    const std::vector<Vicinity> all = vicinities(mesh);
    for (std::size_t i = 0; i < all.size(); ++i)
    {
        const double length = all[i].normal.norm();
        if (!(length > 0.0))
        {
            continue; // No face, or faces that cancel out: there is no direction to move in.
        }
        const double way =
            share * test::signed_unit(seed, i) * all[i].edge_length_sum / all[i].edges / length;
        for (int axis = 0; axis < 3; ++axis)
        {
            noisy.positions[i][static_cast<std::size_t>(axis)] += way * all[i].normal[axis];
        }
    }
    return noisy;
}

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
