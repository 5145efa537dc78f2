// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Simplification compared with the peers: the same mesh on its integer grid, the same number of
/// faces.

#include "host_tools/mesh/prepare.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "tests/bench/encoder_cases.hpp"
#include "tests/bench/feature_edges.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/peers/mesh_simplifier.hpp"
#include "tests/bench/surface_error.hpp"

#include <optional>

namespace tactus::bench
{

namespace
{

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

std::vector<Segment> edges_of(const TriangleMesh& mesh, Feature feature)
{
    return feature == Feature::borders       ? border_edges(mesh)
           : feature == Feature::sharp_edges ? sharp_edges(mesh, kSharpAngle_deg)
                                             : std::vector<Segment>{};
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
    std::vector<Segment> features_;
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
        const std::vector<Segment> kept = edges_of(mesh, context_.mesh.feature);
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
