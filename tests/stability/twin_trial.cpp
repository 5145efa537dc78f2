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
#include "tests/shared/period.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/surface_slide.hpp"
#include "tests/shared/test_model.hpp"
#include "tests/stability/trial_terms.hpp"
#include "tests/stability/whole_model.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::test
{
namespace
{

/// Hand that presses a sphere 0.5 to 1 mm into an object. Activities are random, each for some
/// hundred frames of 1 ms: it rests, slides at 0.02 to 0.1 diag/s, taps, or lifts off and descends
/// elsewhere. Computed from the full mesh alone, in the model frame; lengths of the world are
/// divided by the object's scale.
class PressMotion
{
public:
    /// Starts with a radius in the world. All arguments must outlive the motion.
    PressMotion(const TestModel& model, const FaceTree& tree, double radius_m, double scale,
                Random& random);

    [[nodiscard]] Vec3 next();
    /// Name of the present activity, for a report.
    [[nodiscard]] const char* activity() const;

private:
    enum class Activity : std::uint8_t
    {
        hop, ///< First activity.
        rest,
        slide,
        tap,
    };

    void begin();
    [[nodiscard]] double wanted_depth_m();
    void slide_from(const Vec3& place_m, double speed_diag_per_s);

    const TestModel& model_;
    const FaceTree& tree_;
    double radius_m_;
    double scale_;
    Random& random_;
    std::optional<SurfaceSlide> slide_;
    Vec3 guide_m_{0.0, 0.0, 0.0}; ///< Centre of a sliding sphere; the goal is beside it.
    Vec3 normal_{0.0, 0.0, 1.0};  ///< Normal from the surface to that sphere.
    double depth_m_{0.0}; ///< Depth of the sphere in the surface, in the world; negative above it.
    double pressed_m_{0.0};
    double change_m_{0.0}; ///< Change of the depth in a frame.
    Activity activity_{Activity::hop};
    std::uint32_t frame_{0};
    std::uint32_t frames_left_{0};
};

/// Radius of the sphere that slides along the surface, for every tool.
constexpr double kFixture_diag = 0.01;
constexpr double kLeastDepth_m = 0.5e-3;
constexpr double kMostDepth_m = 1e-3;
constexpr double kLifted_m = -3e-3;
/// Speeds of the hand's descent and ascent.
constexpr double kSlowest_m_per_s = 0.02;
constexpr double kFastest_m_per_s = 0.3;
constexpr double kSlowestSlide_diag_per_s = 0.02;
constexpr double kFastestSlide_diag_per_s = 0.1;
constexpr double kHop_diag_per_s = 2.0;
constexpr std::uint32_t kHopFrames = 100;
constexpr std::uint32_t kTapFrames = 60;

PressMotion::PressMotion(const TestModel& model, const FaceTree& tree, double radius_m,
                         double scale, Random& random)
    : model_(model)
    , tree_(tree)
    , radius_m_(radius_m)
    , scale_(scale)
    , random_(random)
    , depth_m_(kLifted_m)
{
    const Vec3 middle = 0.5 * (tree.low_m() + tree.high_m());
    const double above = 2.0 * kFixture_diag * model.diagonal_m;
    slide_from(Vec3(middle.x(), middle.y(), tree.high_m().z() + above), kHop_diag_per_s);
    guide_m_ = slide_->next();
    begin();
}

void PressMotion::slide_from(const Vec3& place_m, double speed_diag_per_s)
{
    SlideManner manner;
    manner.diagonal_m = model_.diagonal_m;
    manner.radius_diag = kFixture_diag;
    manner.step_m = speed_diag_per_s * kPeriod_s * model_.diagonal_m;
    manner.rotation_rate = [rate = random_.between(-1.0, 1.0)](std::uint64_t) { return rate; };
    slide_.emplace(tree_, manner, place_m);
}

void PressMotion::begin()
{
    frame_ = 0;
    pressed_m_ = random_.between(kLeastDepth_m, kMostDepth_m);
    change_m_ = random_.between(kSlowest_m_per_s, kFastest_m_per_s) * kPeriod_s;
    const bool hops = activity_ == Activity::hop;
    frames_left_ = kHopFrames + random_.below(hops ? kHopFrames : 4 * kHopFrames);
    const double slow = random_.between(kSlowestSlide_diag_per_s, kFastestSlide_diag_per_s);
    slide_from(guide_m_, hops ? kHop_diag_per_s : slow);
}

Vec3 PressMotion::next()
{
    if (frames_left_ == 0)
    {
        activity_ = static_cast<Activity>(random_.below(4U));
        begin();
    }
    const bool is_up = depth_m_ <= 0.99 * kLifted_m;
    if (activity_ == Activity::slide || (activity_ == Activity::hop && is_up))
    {
        guide_m_ = slide_->next();
    }
    const Vec3 foot = tree_.nearest(guide_m_).point_m;
    normal_ = guide_m_ == foot ? normal_ : (guide_m_ - foot).normalized();
    depth_m_ += std::clamp(wanted_depth_m() - depth_m_, -change_m_, change_m_);
    ++frame_;
    --frames_left_;
    return foot + (radius_m_ - depth_m_) / scale_ * normal_;
}

/// A hop ends before its frames do, with the hand down again.
double PressMotion::wanted_depth_m()
{
    const bool taps_up = activity_ == Activity::tap && frame_ % kTapFrames >= kTapFrames / 2;
    const bool hops_up = activity_ == Activity::hop && frames_left_ > kHopFrames / 2;
    return taps_up || hops_up ? kLifted_m : pressed_m_;
}

const char* PressMotion::activity() const
{
    constexpr std::array<const char*, 4> kNames{"hop", "rest", "slide", "tap"};
    return kNames[static_cast<std::size_t>(activity_)];
}

/// Radius of 4 to 8 mm, with hundreds of faces in reach.
constexpr double kPressedRadius_diag = 0.04;
/// Proxies coincide within the travel of a spring at 0.5 mN, and forces within 0.5 mN.
constexpr double kTogether_m = 1e-6;
constexpr double kTogether_n = 5e-4;
/// A proxy this close to the end of the certified range was limited by it: more than the skin of a
/// point, and more than the smallest step.
constexpr double kStepEnd_m = 1e-6;
constexpr double kStepEnd = 1e-3;
/// Pages for two such tools, few enough that others are evicted.
constexpr std::size_t kCache_bytes = 40 * sizeof(Page);

bool touches(const ToolOutput& tool)
{
    return tool.in_contact && !tool.halted && !tool.over_constrained;
}

std::string text_of(const Vec3& v)
{
    std::array<char, 128> text{};
    std::snprintf(text.data(), text.size(), "(%.9g, %.9g, %.9g)", v.x(), v.y(), v.z());
    return text.data();
}

class ForceTwinRun
{
public:
    explicit ForceTwinRun(const ForceTwinTrial& trial)
        : trial_(trial)
        , random_(Random::seeded(trial.seed))
        , diagonal_m_(random_.between(kSmallest_m, kLargest_m))
        , rig_(trial.model, options(trial.hardship.rig))
        , whole_(trial.model, options(whole_options(trial.model.faces.size())))
        , judges_(trial.tools)
        , last_(trial.tools)
    {
        figures_.steps = {"force step, " + trial.model.name + ", " + trial.hardship.name +
                              (trial.tools > 1 ? ", two tools" : ""),
                          0,
                          0.0,
                          kForceStep_n,
                          "N",
                          0,
                          {}};
        figures_.after_waits = figures_.steps;
        figures_.after_waits.name += ", after a wait";
        ObjectPose pose;
        pose.scale = diagonal_m_ / trial.model.diagonal_m;
        rig_.place_object(pose);
        whole_.place_object(pose);
        for (std::uint32_t tool = 0; tool < trial.tools; ++tool)
        {
            motions_.emplace_back(trial.model, trial.tree, radius_m(), pose.scale, random_);
        }
    }

    [[nodiscard]] ForceTwinFigures run()
    {
        std::vector<Vec3> goals = next_goals();
        refine_fully(figures_.steps.name,
                     [&](const Budgets& budgets) { return whole_.step(goals, budgets); });
        for (frame_ = 0; frame_ < trial_.frames; ++frame_)
        {
            const FrameOutput ours = rig_.step(goals, trial_.hardship.budgets);
            const FrameOutput full = whole_.step(goals, trial_.hardship.budgets);
            for (std::uint32_t tool = 0; tool < trial_.tools; ++tool)
            {
                judge(tool, ours, full, goals[tool]);
            }
            goals = next_goals();
        }
        return figures_;
    }

private:
    [[nodiscard]] double radius_m() const { return trial_.hardship.radius_diag * diagonal_m_; }

    [[nodiscard]] RigOptions options(const RigOptions& of_models) const
    {
        RigOptions options = with_tool(of_models, radius_m());
        options.tools.resize(trial_.tools, ToolSpec(options.tools[0]));
        options.faults.seed = trial_.seed + 1;
        return options;
    }

    [[nodiscard]] std::vector<Vec3> next_goals()
    {
        std::vector<Vec3> goals;
        for (PressMotion& motion : motions_)
        {
            goals.push_back(to_world(rig_.pose(), motion.next()));
        }
        return goals;
    }

    /// True if the answer is settled and the proxy moved as far as it needed, not just as far as
    /// the surface is known.
    [[nodiscard]] bool is_certified(const FrameRig& rig, const FrameOutput& output,
                                    std::uint32_t tool) const
    {
        const PairOutput& pair = output.pairs[tool];
        const std::span<const Vec3> path = rig.frame().tool(tool).path_m();
        const double end_m = (path.back() - path.front()).norm() + radius_m();
        const double known_m = std::max(pair.certified_radius_m, pair.lower_m);
        return (pair.kind == AnswerKind::exact || pair.kind == AnswerKind::separated) &&
               known_m - end_m > kStepEnd_m + kStepEnd * radius_m();
    }

    void judge(std::uint32_t tool, const FrameOutput& ours, const FrameOutput& full,
               const Vec3& goal_m)
    {
        const ToolOutput& a = ours.tools[tool];
        const ToolOutput& b = full.tools[tool];
        figures_.fading += a.halted || a.over_constrained ? 1 : 0;
        judge_wait(tool, a, goal_m);
        const bool is_answered = is_certified(rig_, ours, tool) &&
                                 is_certified(whole_, full, tool) && !a.under_way && !b.under_way;
        const std::optional<ForceStepJudge::Step> step = judges_[tool].judge(a, b, is_answered);
        if (!step)
        {
            return;
        }
        if (!step->is_certified)
        {
            ++figures_.data_limited;
            figures_.data_limited_n = std::max(figures_.data_limited_n, step->newtons);
            return;
        }
        ++figures_.steps.trials;
        figures_.steps.observe(step->newtons);
        figures_.apart_n = std::max(figures_.apart_n, (a.force_n - b.force_n).norm());
        figures_.refining += ours.work.splits > 0 ? 1 : 0;
        figures_.coarsening += ours.work.merges > 0 ? 1 : 0;
        figures_.adopting += ours.work.pages_adopted > 0 ? 1 : 0;
        if (step->newtons > kForceStep_n)
        {
            flag(tool, ours, full, goal_m, step->newtons);
        }
    }

    /// A force after a wait continues from its last value: the hand's motion changes it by the
    /// spring at most.
    void judge_wait(std::uint32_t tool, const ToolOutput& now, const Vec3& goal_m)
    {
        Last& last = last_[tool];
        if (last.has_waited && touches(now))
        {
            const double by_device_n = ToolSpec{}.stiffness_n_per_m * (goal_m - last.goal_m).norm();
            const double step_n = (now.force_n - last.force_n).norm() - by_device_n;
            ++figures_.after_waits.trials;
            figures_.after_waits.observe(std::max(0.0, step_n));
            if (step_n > kForceStep_n)
            {
                figures_.after_waits.flag(
                    figures_.after_waits.name + ", TACTUS_SEED=" + std::to_string(trial_.seed) +
                    ", frame " + std::to_string(frame_) + " (" + motions_[tool].activity() +
                    "): step of " + std::to_string(step_n) + " N; force " + text_of(last.force_n) +
                    ", then " + text_of(now.force_n));
            }
        }
        last = {now.force_n, goal_m, now.halted || now.over_constrained || now.data_limited};
    }

    void flag(std::uint32_t tool, const FrameOutput& ours, const FrameOutput& full,
              const Vec3& goal_m, double step_n)
    {
        const ToolOutput& a = ours.tools[tool];
        const ToolOutput& b = full.tools[tool];
        figures_.steps.flag(figures_.steps.name + ", TACTUS_SEED=" + std::to_string(trial_.seed) +
                            ", frame " + std::to_string(frame_) + " (" + motions_[tool].activity() +
                            "): step of " + std::to_string(step_n) + " N; goal " + text_of(goal_m) +
                            ", proxy " + text_of(a.proxy_m) + ", twin's " + text_of(b.proxy_m) +
                            ", force " + text_of(a.force_n) + ", twin's " + text_of(b.force_n) +
                            ", faults " + std::to_string(static_cast<std::uint32_t>(ours.faults)) +
                            ", answer " + std::to_string(static_cast<int>(ours.pairs[tool].kind)) +
                            ", certified " + std::to_string(ours.pairs[tool].certified_radius_m) +
                            ", twin's " + std::to_string(full.pairs[tool].certified_radius_m));
    }

    struct Last
    {
        Vec3 force_n{0.0, 0.0, 0.0};
        Vec3 goal_m{0.0, 0.0, 0.0};
        bool has_waited{false};
    };

    const ForceTwinTrial& trial_;
    Random random_;
    double diagonal_m_;
    FrameRig rig_;
    FrameRig whole_;
    std::vector<PressMotion> motions_;
    std::vector<ForceStepJudge> judges_;
    std::vector<Last> last_;
    ForceTwinFigures figures_;
    std::uint32_t frame_{0};
};

} // namespace

std::optional<ForceStepJudge::Step> ForceStepJudge::judge(const ToolOutput& ours,
                                                          const ToolOutput& twins, bool is_answered)
{
    const Vec3 change = ours.force_n - ours_n_;
    const Vec3 twins_change = twins.force_n - twins_n_;
    const bool are_touching = touches(ours) && touches(twins);
    const bool are_certified = are_touching && is_answered;
    std::optional<Step> step;
    if (were_touching_ && are_touching)
    {
        step =
            Step{(change - twins_change).norm(), were_certified_ && are_certified && !are_apart_};
    }
    const bool are_together = (ours.proxy_m - twins.proxy_m).norm() <= kTogether_m &&
                              (ours.force_n - twins.force_n).norm() <= kTogether_n;
    are_apart_ = !are_together && (are_apart_ || !are_certified);
    ours_n_ = ours.force_n;
    twins_n_ = twins.force_n;
    were_touching_ = are_touching;
    were_certified_ = are_certified;
    return step;
}

std::vector<Hardship> force_hardships(const TestModel& model)
{
    std::vector<Hardship> chosen;
    for (const char* name : {"usual", "point", "K-1", "K-4", "small-pools", "few-pages", "no-cache",
                             "lossy-link", "late-link"})
    {
        Hardship& hardship = chosen.emplace_back(hardship_named(model, name));
        hardship.radius_diag = hardship.radius_diag > 0.0 ? kPressedRadius_diag : 0.0;
        hardship.rig.cache_bytes =
            std::min(hardship.rig.cache_bytes, std::size_t{1}) * kCache_bytes;
    }
    return chosen;
}

ForceTwinFigures run_force_twin_trial(const ForceTwinTrial& trial)
{
    return ForceTwinRun(trial).run();
}

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
