// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/stability/twin_trial.hpp"

#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/geometry/placed_core.hpp"
#include "rt_core/query/contact_report.hpp"
#include "rt_core/query/core_query.hpp"
#include "rt_core/query/surface_query.hpp"
#include "tests/shared/closest_point.hpp"
#include "tests/shared/owned_surface.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/surface_slide.hpp"
#include "tests/stability/same_bits.hpp"
#include "tests/stability/trial_terms.hpp"
#include "tests/stability/whole_model.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::test
{

namespace
{

constexpr double kSpeed_diag = 0.1e-3; ///< Step of a frame of 1 ms: 0.1 diag/s.
/// Size of the cores, and their distance from the centre of the certified sphere.
constexpr double kCoreSize_diag = 0.004;
constexpr double kCoreReach_diag = 0.0102;
constexpr std::uint32_t kTwinSettling = 100; ///< Frames until the model is refined at the tool.

/// Exact face with its place.
struct NearFace
{
    std::uint32_t face{0};
    std::array<Vec3f, 3> corners_m{};

    friend bool operator==(const NearFace&, const NearFace&) = default;
};

using FaceSet = std::vector<NearFace>;

/// Answer of the whole query, with budgets that never end it.
OwnedSurface surface_at(const AbTree& tree, const Vec3& center_m, double reach_m)
{
    OwnedSurface surface;
    QueryMemory memory;
    WalkBudget budget{1'000'000'000, 1'000'000'000};
    gather_surface(tree, center_m, reach_m, memory, budget, surface);
    return surface;
}

/// Faces within the radius by the oracle's distance, in the order of their ids.
FaceSet faces_within(const AbTree& tree, const LocalSurface& surface, double radius_m)
{
    const Vec3& p = surface.center_m;
    const WidePoint place{static_cast<long double>(p.x()), static_cast<long double>(p.y()),
                          static_cast<long double>(p.z())};
    FaceSet faces;
    for (std::uint32_t i = 0; i < surface.count; ++i)
    {
        const LocalTriangle& triangle = surface.triangles[i];
        if (wide_distance(place, triangle.corners_m) < static_cast<long double>(radius_m))
        {
            faces.push_back({tree.face_of(triangle.prim).value, triangle.corners_m});
        }
    }
    std::sort(faces.begin(), faces.end(),
              [](const NearFace& a, const NearFace& b) { return a.face < b.face; });
    return faces;
}

/// Difference between the answers of the refined and the whole mesh; empty if there is none.
std::string difference(const AbTree& refined, const AbTree& whole, const Vec3& center_m,
                       double radius_m)
{
    const OwnedSurface ours = surface_at(refined, center_m, radius_m);
    const OwnedSurface full = surface_at(whole, center_m, radius_m);
    const DistanceAnswer& a = ours.answer;
    const DistanceAnswer& b = full.answer;
    const double certified = std::min(a.certified_radius_m, b.certified_radius_m);
    if (faces_within(refined, ours, certified) != faces_within(whole, full, certified))
    {
        return "the faces within " + std::to_string(certified) + " m differ";
    }
    const bool is_exact = a.kind == AnswerKind::exact;
    if (a.kind != b.kind || (is_exact && a.nearest_face != b.nearest_face))
    {
        return "answer " + std::to_string(static_cast<int>(a.kind)) + " by face " +
               std::to_string(a.nearest_face.value) + ", and of the whole mesh " +
               std::to_string(static_cast<int>(b.kind)) + " by face " +
               std::to_string(b.nearest_face.value);
    }
    if (is_exact && (!same_bits(a.lower_m, b.lower_m) || !same_bits(a.upper_m, b.upper_m)))
    {
        return "the distances differ";
    }
    if (is_exact && (!same_bits(a.nearest_point_m, b.nearest_point_m) ||
                     a.nearest_feature != b.nearest_feature))
    {
        return "the nearest points differ";
    }
    return "";
}

struct Findings
{
    OwnedSurface surface;
    ContactReport report;

    Findings(const AbTree& tree, const PlacedCore& core, double radius_m, bool is_closed)
    {
        QueryMemory memory;
        WalkBudget budget{1'000'000'000, 1'000'000'000};
        gather_surface(tree, core, 1.05 * radius_m, memory, budget, surface);
        report_contacts(core, radius_m, tree, surface, is_closed, report);
    }
};

bool same_answer(const DistanceAnswer& a, const DistanceAnswer& b)
{
    return a.kind == b.kind && a.nearest_face == b.nearest_face &&
           a.nearest_feature == b.nearest_feature && same_bits(a.lower_m, b.lower_m) &&
           same_bits(a.upper_m, b.upper_m) && same_bits(a.nearest_point_m, b.nearest_point_m) &&
           same_bits(a.tool_point_m, b.tool_point_m);
}

/// Core of each kind in turn, with a random rotation, about `size_m` large.
PlacedCore twin_core(std::uint32_t turn, const Vec3& center_m, double size_m, Random& random)
{
    static const std::array<Vec3, 5> kWedge{Vec3(-0.5, 0, 0), Vec3(0.5, 0, 0), Vec3(0, 0.6, 0),
                                            Vec3(0, 0, 0.7), Vec3(0.2, 0.2, 0.2)};
    static const Hull wedge = Hull::create(kWedge).value();
    const Eigen::Quaterniond rotation{random.between(0.1, 1.0), random.between(-1.0, 1.0),
                                      random.between(-1.0, 1.0), random.between(-1.0, 1.0)};
    const Similarity place{rotation.normalized().toRotationMatrix(), center_m, size_m};
    switch (turn % 4)
    {
    case 0:
        return {PointCore{}, place};
    case 1:
        return {Segment{Vec3(-0.5, 0.0, 0.0), Vec3(0.5, 0.0, 0.0)}, place};
    case 2:
        return {Box{Vec3(0.5, 0.3, 0.1)}, place};
    default:
        return {wedge, place};
    }
}

/// Difference between the findings of a core in a refined and in a whole mesh: its contacts within
/// `radius_m` and, of an exact answer, nearest points, normal and side. An empty text if equal, no
/// value if the refined mesh does not certify enough.
std::optional<std::string> core_difference(const AbTree& refined, const AbTree& whole,
                                           const PlacedCore& core, double radius_m, bool is_closed)
{
    const Findings ours(refined, core, radius_m, is_closed);
    const Findings full(whole, core, radius_m, is_closed);
    const DistanceAnswer& a = ours.surface.answer;
    const DistanceAnswer& b = full.surface.answer;
    if (a.certified_radius_m < radius_m)
    {
        return std::nullopt;
    }
    if (a.kind == AnswerKind::exact ? !same_answer(a, b) : b.upper_m <= radius_m)
    {
        return "the nearest points differ";
    }
    if (!same_bits(ours.report.contacts, full.report.contacts) ||
        ours.report.is_complete != full.report.is_complete)
    {
        return "the contacts differ";
    }
    if (a.kind == AnswerKind::exact && (!same_bits(ours.report.normal, full.report.normal) ||
                                        ours.report.side != full.report.side))
    {
        return "the normals or sides differ";
    }
    return "";
}

/// Rig that has refined everything.
std::unique_ptr<FrameRig> whole_model(const TestModel& model)
{
    auto rig = std::make_unique<FrameRig>(model, whole_options(model.faces.size()));
    refine_fully(model.name, [&](const Budgets& budgets)
                 { return rig->step(to_vec3(model.faces[0][0]), budgets); });
    return rig;
}

SurfaceSlide slide_over(const TwinTrial& trial, Random& random)
{
    SlideManner manner;
    manner.diagonal_m = trial.model.diagonal_m;
    manner.radius_diag = kRadius_diag;
    manner.step_m = kSpeed_diag * trial.model.diagonal_m;
    manner.rotation_rate = [seed = random.bits()](std::uint64_t turn)
    { return Random::seeded(seed + turn).between(-1.0, 1.0); };
    // The slide begins above the model, where nothing is in the proxy's way.
    const Vec3 top = trial.tree.high_m() + Vec3(0.0, 0.0, 0.01 * trial.model.diagonal_m);
    const Vec3 middle = 0.5 * (trial.tree.low_m() + trial.tree.high_m());
    return {trial.tree, manner, Vec3(middle.x(), middle.y(), top.z())};
}

/// Records a violation unless the text is empty.
void flag(const std::string& text, const TwinTrial& trial, std::uint32_t frame,
          TrialFigures& figures)
{
    if (!text.empty())
    {
        figures.flag(figures.name + ", TACTUS_SEED=" + std::to_string(trial.seed) + ", frame " +
                     std::to_string(frame) + ": " + text);
        figures.observe(static_cast<double>(figures.violations));
    }
}

} // namespace

TwinFigures run_twin_trial(const TwinTrial& trial)
{
    Random random = Random::seeded(trial.seed);
    const std::unique_ptr<FrameRig> whole = whole_model(trial.model);
    FrameRig rig(trial.model, {});
    SurfaceSlide slide = slide_over(trial, random);
    TwinFigures figures;
    figures.identity = {trial.model.name + ", identical", 0, 0.0, 0.0, "differences", 0, {}};
    figures.uncertified = {
        trial.model.name + ", uncertified", 0, 0.0, kUncertifiedShare, "of the frames", 0, {}};
    figures.cores = {trial.model.name + ", contacts", 0, 0.0, 0.0, "differences", 0, {}};
    std::uint64_t open = 0;
    for (std::uint32_t frame = 0; frame < trial.frames + kTwinSettling; ++frame)
    {
        const PairOutput pair = rig.step(slide.next()).pairs[0];
        if (frame < kTwinSettling)
        {
            continue;
        }
        ++figures.uncertified.trials;
        if (pair.kind != AnswerKind::exact && pair.kind != AnswerKind::separated)
        {
            ++open;
            continue;
        }
        ++figures.identity.trials;
        const std::string text = difference(rig.model().tree, whole->model().tree, pair.point_m,
                                            pair.certified_radius_m);
        flag(text, trial, frame, figures.identity);
        const double size_m = kCoreSize_diag * trial.model.diagonal_m;
        const PlacedCore core = twin_core(frame, pair.point_m, size_m, random);
        if (const auto of_core =
                core_difference(rig.model().tree, whole->model().tree, core,
                                kCoreReach_diag * trial.model.diagonal_m - core.radius(),
                                rig.model().header.is_closed()))
        {
            ++figures.cores.trials;
            flag(*of_core, trial, frame, figures.cores);
        }
    }
    figures.uncertified.observe(static_cast<double>(open) / trial.frames);
    return figures;
}

} // namespace tactus::test
