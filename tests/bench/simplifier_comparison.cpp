// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Simplification compared with the peers: the same mesh on its integer grid, the same number of
/// faces.

#include "host_tools/mesh/prepare.hpp"
#include "host_tools/mesh/triangle_mesh.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "rt_core/math/vec3.hpp"
#include "tests/bench/bench_row.hpp"
#include "tests/bench/encoder_cases.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/peers/all_peers.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/shared/brute_force.hpp"
#include "tests/shared/face_tree.hpp"
#include "tests/shared/random.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

namespace tactus::bench
{
namespace
{

struct FeatureLine
{
    Vec3 from{0.0, 0.0, 0.0};
    Vec3 to{0.0, 0.0, 0.0};
};

/// Distance between two surfaces, in the meshes' unit.
struct SurfaceError
{
    double rms{0.0};
    double max{0.0};
};

/// Measures other meshes against one: as many samples of each surface to the other surface; root of
/// the mean square and maximum. Corners are rounded to float.
class SurfaceReference
{
public:
    SurfaceReference(const TriangleMesh& original, std::uint32_t samples);
    SurfaceReference(const SurfaceReference&) = delete;
    SurfaceReference& operator=(const SurfaceReference&) = delete;

    /// Error of the other mesh; about a microsecond a sample.
    [[nodiscard]] SurfaceError error_of(const TriangleMesh& other) const;

private:
    std::vector<Vec3> samples_;
    std::vector<test::Face> faces_;
    test::FaceTree tree_;
};

/// Side of a face, ends in ascending order: sides of one edge differ only in the face.
struct Side
{
    std::uint32_t low;
    std::uint32_t high;
    std::uint32_t face;

    [[nodiscard]] bool is_same_edge(const Side& other) const
    {
        return low == other.low && high == other.high;
    }
};

Vec3 place(const TriangleMesh& mesh, std::uint32_t vertex)
{
    const std::array<double, 3>& at = mesh.positions[vertex];
    return {at[0], at[1], at[2]};
}

Vec3 normal(const TriangleMesh& mesh, std::uint32_t face)
{
    const auto& [a, b, c] = mesh.faces[face];
    return (place(mesh, b) - place(mesh, a)).cross(place(mesh, c) - place(mesh, a));
}

std::vector<Side> sorted_sides(const TriangleMesh& mesh)
{
    std::vector<Side> sides;
    sides.reserve(3 * mesh.faces.size());
    for (std::uint32_t face = 0; face < mesh.faces.size(); ++face)
    {
        for (std::size_t i = 0; i < 3; ++i)
        {
            const auto [low, high] =
                std::minmax({mesh.faces[face][i], mesh.faces[face][(i + 1) % 3]});
            sides.push_back({low, high, face});
        }
    }
    std::sort(sides.begin(), sides.end(),
              [](const Side& a, const Side& b)
              { return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face); });
    return sides;
}

/// Edges that satisfy `is_wanted(sides)`.
template <typename Condition>
std::vector<FeatureLine> edges_where(const TriangleMesh& mesh, const Condition& is_wanted)
{
    const std::vector<Side> sides = sorted_sides(mesh);
    std::vector<FeatureLine> edges;
    for (auto begin = sides.begin(); begin != sides.end();)
    {
        const auto end = std::find_if_not(
            begin, sides.end(), [&](const Side& side) { return side.is_same_edge(*begin); });
        if (is_wanted(std::span(begin, end)))
        {
            edges.push_back({place(mesh, begin->low), place(mesh, begin->high)});
        }
        begin = end;
    }
    return edges;
}

double distance(const Vec3& point, const FeatureLine& segment)
{
    const Vec3 along = segment.to - segment.from;
    const double squared = along.squaredNorm();
    const double share =
        squared > 0.0 ? std::clamp((point - segment.from).dot(along) / squared, 0.0, 1.0) : 0.0;
    return (segment.from + share * along - point).norm();
}

double nearest_distance(const Vec3& point, const std::vector<FeatureLine>& segments)
{
    double least = std::numeric_limits<double>::infinity();
    for (const FeatureLine& segment : segments)
    {
        least = std::min(least, distance(point, segment));
    }
    return least;
}

/// Edges of a single face.
std::vector<FeatureLine> border_edges(const TriangleMesh& mesh)
{
    return edges_where(mesh, [](std::span<const Side> sides) { return sides.size() == 1; });
}

/// Edges at which the surface turns by more than `angle_deg`, 0 .. 180; faces without an area do
/// not count.
std::vector<FeatureLine> sharp_edges(const TriangleMesh& mesh, double angle_deg)
{
    const double least_cosine = std::cos(angle_deg / 180.0 * std::numbers::pi);
    const auto is_sharp = [&](std::span<const Side> sides)
    {
        const Vec3 first = normal(mesh, sides.front().face);
        return std::any_of(sides.begin() + 1, sides.end(),
                           [&](const Side& side)
                           {
                               const Vec3 other = normal(mesh, side.face);
                               const double scale = first.norm() * other.norm();
                               return first.dot(other) < least_cosine * scale;
                           });
    };
    return edges_where(mesh, is_sharp);
}

/// Greatest distance of points of `lines` to the nearest of `others`. The points include the ends
/// and are at most one `points`-th of the total length apart. Infinity without others, 0 without
/// lines. The cost is the product of both counts.
double largest_distance(const std::vector<FeatureLine>& lines,
                        const std::vector<FeatureLine>& others, unsigned points)
{
    double length = 0.0;
    for (const FeatureLine& line : lines)
    {
        length += (line.to - line.from).norm();
    }
    double largest = 0.0;
    for (const FeatureLine& line : lines)
    {
        const Vec3 along = line.to - line.from;
        const auto steps = static_cast<unsigned>(std::ceil(along.norm() * points / length));
        for (unsigned step = 0; step <= steps; ++step)
        {
            const double share = steps == 0 ? 0.0 : static_cast<double>(step) / steps;
            largest = std::max(largest, nearest_distance(line.from + share * along, others));
        }
    }
    return largest;
}

using Corners = std::array<Vec3, 3>;

Corners corners_of(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& face)
{
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i)
    {
        const std::array<double, 3>& at = mesh.positions[face[i]];
        corners[i] = Vec3(at[0], at[1], at[2]);
    }
    return corners;
}

double area_of(const Corners& corners)
{
    return 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
}

/// Three independent values in 0 .. 1 for each index.
double unit(std::uint64_t seed, std::uint64_t index, std::uint64_t which)
{
    return 0.5 + 0.5 * test::signed_unit(seed, 3 * index + which);
}

Vec3 point_on(const Corners& corners, double s, double t)
{
    if (s + t > 1.0)
    {
        s = 1.0 - s;
        t = 1.0 - t;
    }
    return corners[0] + s * (corners[1] - corners[0]) + t * (corners[2] - corners[0]);
}

void add_distances(const std::vector<Vec3>& points, const test::FaceTree& tree, SurfaceError& sum)
{
    for (const Vec3& point : points)
    {
        const double distance = tree.nearest(point).distance_m;
        sum.rms += distance * distance;
        sum.max = std::max(sum.max, distance);
    }
}

/// `count` points, at least one, of a mesh with an area: one at a random place of each equal share
/// of the area.
std::vector<Vec3> surface_samples(const TriangleMesh& mesh, std::uint32_t count, std::uint64_t seed)
{
    double area = 0.0;
    for (const auto& face : mesh.faces)
    {
        area += area_of(corners_of(mesh, face));
    }
    std::vector<Vec3> samples;
    samples.reserve(count);
    double passed = 0.0; // Area of the faces before.
    const auto next = [&]
    {
        const std::size_t index = samples.size();
        return (static_cast<double>(index) + unit(seed, index, 0)) / count * area;
    };
    for (const auto& face : mesh.faces)
    {
        const Corners corners = corners_of(mesh, face);
        passed += area_of(corners);
        while (samples.size() < count && next() <= passed)
        {
            const std::size_t index = samples.size();
            samples.push_back(point_on(corners, unit(seed, index, 1), unit(seed, index, 2)));
        }
    }
    return samples;
}

SurfaceReference::SurfaceReference(const TriangleMesh& original, std::uint32_t samples)
    : samples_(surface_samples(original, samples, kSeed)), faces_(faces_of(original)), tree_(faces_)
{
}

SurfaceError SurfaceReference::error_of(const TriangleMesh& other) const
{
    const auto count = static_cast<std::uint32_t>(samples_.size());
    const std::vector<Vec3> others = surface_samples(other, count, kSeed + 1);
    const std::vector<test::Face> faces = faces_of(other);
    SurfaceError error;
    add_distances(samples_, test::FaceTree(faces), error);
    add_distances(others, tree_, error);
    error.rms = std::sqrt(error.rms / static_cast<double>(samples_.size() + others.size()));
    return error;
}

/// Target of the simplification: one face of this many.
constexpr std::uint32_t kOneFaceIn = 100;
constexpr double kSharpAngle_deg = 40.0;
constexpr unsigned kFeaturePoints = 10'000;

/// Mesh in quanta, the unit of all results.
TriangleMesh on_grid(const QuantisedMesh& mesh)
{
    TriangleMesh made;
    made.faces = mesh.faces;
    for (const auto& [x, y, z] : mesh.positions)
    {
        made.positions.push_back(
            {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
    }
    return made;
}

/// Our simplifier, with certificate and collapses; building the adjacency is in its time.
template <unsigned kThreads>
SimplifiedMesh simplify_by_us(const QuantisedMesh& mesh, std::uint32_t faces)
{
    SimplifyOptions options;
    options.base_faces = faces;
    options.threads = kThreads;
    const BenchClock::time_point start = BenchClock::now();
    const Simplification simplified = needed(simplify(mesh, options));
    const BenchClock::time_point end = BenchClock::now();
    SimplifiedMesh made{on_grid(mesh), seconds(start, end)};
    made.mesh.faces = simplified.base_corners;
    return made;
}

const MeshSimplifier kOurs{"Tactus", simplify_by_us<1>};
const MeshSimplifier kOursOnTwo{"Tactus, 2 threads", simplify_by_us<2>};

std::vector<FeatureLine> edges_of(const TriangleMesh& mesh, Feature feature)
{
    return feature == Feature::borders       ? border_edges(mesh)
           : feature == Feature::sharp_edges ? sharp_edges(mesh, kSharpAngle_deg)
                                             : std::vector<FeatureLine>{};
}

/// FNV-1a over the faces' corners, so that the timed result is used.
std::uint64_t hash_of(const TriangleMesh& mesh)
{
    std::uint64_t hash = 0xCBF2'9CE4'8422'2325;
    for (const auto& face : mesh.faces)
    {
        for (const auto corner : face)
        {
            hash = (hash ^ static_cast<std::uint64_t>(corner)) * 0x100'0000'01B3;
        }
    }
    return hash;
}

/// Measures simplified versions of one mesh and adds their rows.
class Comparison
{
public:
    Comparison(const EncoderContext& context, std::string scene, const PreparedMesh& prepared)
        : context_(context)
        , scene_(std::move(scene))
        , mesh_(prepared.mesh)
        , original_(on_grid(prepared.mesh))
        , features_(edges_of(original_, context.mesh.feature))
        , diagonal_quanta_(prepared.diagonal_m / prepared.quantum_m)
        , samples_(context.options.quick ? 100'000 : 500'000)
        , reference_(original_, samples_)
    {
    }

    void run();

private:
    [[nodiscard]] CaseRows line_of(const MeshSimplifier& simplifier,
                                   const TriangleMesh& mesh) const;
    [[nodiscard]] SimplifiedMesh fastest(const MeshSimplifier& simplifier) const;
    void add_time(CaseRows& rows, double seconds) const;
    [[nodiscard]] SurfaceError add_quality(CaseRows& rows, const TriangleMesh& mesh) const;
    void add_ratios(CaseRows& rows, const MeshSimplifier& peer, const SurfaceError& ours,
                    const SurfaceError& theirs) const;

    const EncoderContext& context_;
    std::string scene_;
    const QuantisedMesh& mesh_;
    TriangleMesh original_;
    std::vector<FeatureLine> features_;
    double diagonal_quanta_;
    std::uint32_t samples_; ///< Samples of each surface.
    SurfaceReference reference_;
};

void Comparison::run()
{
    const SimplifiedMesh on_two = fastest(kOursOnTwo);
    const PinnedCore pinned(context_.options.core);
    const SimplifiedMesh ours = fastest(kOurs);
    if (ours.mesh.faces != on_two.mesh.faces)
    {
        throw Failure("one thread and two simplify it differently");
    }
    CaseRows our_rows = line_of(kOurs, ours.mesh);
    const SurfaceError our_error = add_quality(our_rows, ours.mesh);
    add_time(our_rows, ours.seconds);
    CaseRows rows_on_two = line_of(kOursOnTwo, on_two.mesh);
    add_time(rows_on_two, on_two.seconds);
    for (const MeshSimplifier& peer :
         context_.options.count ? std::vector<MeshSimplifier>{} : mesh_simplifiers())
    {
        const SimplifiedMesh theirs = fastest(peer);
        CaseRows rows = line_of(peer, theirs.mesh);
        const SurfaceError error = add_quality(rows, theirs.mesh);
        add_time(rows, theirs.seconds);
        add_ratios(rows, peer, our_error, error);
    }
}

CaseRows Comparison::line_of(const MeshSimplifier& simplifier, const TriangleMesh& mesh) const
{
    Row common = context_.common_row(scene_, "Simplification");
    common.by = simplifier.name;
    common.frames = samples_;
    common.hash = hash_of(mesh);
    return {context_.rows, common};
}

SimplifiedMesh Comparison::fastest(const MeshSimplifier& simplifier) const
{
    const auto faces = static_cast<std::uint32_t>(mesh_.faces.size()) / kOneFaceIn;
    SimplifiedMesh best = simplifier.simplify(mesh_, faces);
    for (std::uint32_t pass = 1; pass < context_.options.passes_or(3, 1); ++pass)
    {
        SimplifiedMesh next = simplifier.simplify(mesh_, faces);
        if (next.seconds < best.seconds)
        {
            best = std::move(next);
        }
    }
    return best;
}

void Comparison::add_time(CaseRows& rows, double seconds) const
{
    rows.add("time", seconds, "s");
    rows.add("a face", 1e6 * seconds / static_cast<double>(mesh_.faces.size()), "us");
}

SurfaceError Comparison::add_quality(CaseRows& rows, const TriangleMesh& mesh) const
{
    const SurfaceError error = reference_.error_of(mesh);
    const double unit = diagonal_quanta_ / 1e3;
    rows.add("faces", static_cast<double>(mesh.faces.size()), "");
    rows.add("RMS", error.rms / unit, "1e-3 diag");
    rows.add("max", error.max / unit, "1e-3 diag");
    if (!features_.empty())
    {
        const std::vector<FeatureLine> kept = edges_of(mesh, context_.mesh.feature);
        rows.add("features", largest_distance(features_, kept, kFeaturePoints) / unit, "1e-3 diag");
    }
    return error;
}

void Comparison::add_ratios(CaseRows& rows, const MeshSimplifier& peer, const SurfaceError& ours,
                            const SurfaceError& theirs) const
{
    const EncoderGoals& goals = context_.mesh.goals;
    const bool is_cgal = peer.name == kGarlandHeckbert;
    const auto add = [&](const char* metric, double our, double their, std::optional<double> goal)
    {
        Row& row = rows.add(metric, our / their, "x its", goal);
        row.peer = peer.name;
        row.peer_value = their / diagonal_quanta_ * 1e3;
    };
    add("ours in RMS", ours.rms, theirs.rms,
        is_cgal                       ? goals.rms_to_garland_heckbert
        : peer.name == kMeshoptimizer ? goals.rms_to_meshoptimizer
                                      : std::nullopt);
    add("ours in max", ours.max, theirs.max,
        is_cgal ? goals.max_to_garland_heckbert : std::nullopt);
}

} // namespace

void compare_simplifiers(const EncoderContext& context)
{
    if (!context.mesh.is_compared)
    {
        return;
    }
    auto named = context.mesh.make();
    const auto prepared = needed(prepare_mesh(named.mesh, {}));
    named.mesh = {};
    Comparison(context, named.name, prepared).run();
}

} // namespace tactus::bench
