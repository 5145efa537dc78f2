// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

#include "tests/stability/pop_through_trial.hpp"

#include "rt_core/limits.hpp"
#include "tests/shared/exact_meet.hpp"
#include "tests/shared/period.hpp"
#include "tests/shared/safe_force.hpp"
#include "tests/stability/random_motion.hpp"
#include "tests/stability/tool_oracle.hpp"
#include "tests/stability/trial_terms.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

namespace tactus::test
{
namespace
{

Vec3 place_of(const ObjectPose& pose, const Vec3& world_m)
{
    const WidePoint place = wide_place(pose, world_m);
    return {static_cast<double>(place[0]), static_cast<double>(place[1]),
            static_cast<double>(place[2])};
}

} // namespace

std::string Crossing::text() const
{
    std::array<char, 256> text{};
    std::snprintf(text.data(), text.size(), "(%.17g, %.17g, %.17g) to (%.17g, %.17g, %.17g)",
                  from_m.x(), from_m.y(), from_m.z(), to_m.x(), to_m.y(), to_m.z());
    return "face " + std::to_string(face) + " met from " + text.data();
}

std::optional<Crossing> find_crossing(const TestModel& model, const FaceTree& tree,
                                      const Vec3& from_m, const Vec3& to_m)
{
    for (const std::uint32_t face :
         tree.faces_near_box(from_m.cwiseMin(to_m), from_m.cwiseMax(to_m)))
    {
        const Face& corners = model.faces[face];
        const Triangle triangle{to_vec3(corners[0]), to_vec3(corners[1]), to_vec3(corners[2])};
        if (exactly_meet(from_m, to_m, triangle))
        {
            return Crossing{from_m, to_m, face};
        }
    }
    return std::nullopt;
}

ProxyTrail::Crossings ProxyTrail::follow(std::span<const Vec3> path_m, const ObjectPose& pose)
{
    Crossings crossings;
    bool is_carried = true;
    for (const Vec3& place : path_m)
    {
        const Vec3 next = place_of(pose, place);
        if (last_m_ && *last_m_ != next)
        {
            std::optional<Crossing>& found = is_carried ? crossings.carried : crossings.moved;
            found = found ? found : find_crossing(*model_, *tree_, *last_m_, next);
        }
        last_m_ = next;
        is_carried = false;
    }
    return crossings;
}

namespace
{

constexpr double kForceRounding_n = 1e-9;
constexpr double kStiffnessRounding = 1e-9;

/// Tool radius while the objects close in, and frames that they stay.
constexpr double kSqueezedRadius_diag = 0.05;
constexpr std::uint32_t kRestFrames = 100;
/// Greatest speed of a single moving object: more than a tool's reach in a frame.
constexpr double kFastestJaw_m_per_s = 20.0;

/// Width with a logarithmic distribution.
double any_shading_width_m(Random& random)
{
    return kShadingWidthMin_m *
           std::pow(kShadingWidthMax_m / kShadingWidthMin_m, random.between(0.0, 1.0));
}

/// Compares the frames of one tool with its trail past each object.
class PopThroughJudge
{
public:
    PopThroughJudge(std::string name, std::uint64_t seed) : seed_(seed)
    {
        figures_.crossings = {std::move(name), 0, 0.0, 0.0, "frames", 0, {}};
        figures_.run_over = figures_.crossings;
        figures_.run_over.name += ", run over";
    }

    /// Starts a proxy without a place, and `objects` of one model.
    void begin(std::size_t objects, const TestModel& model, const FaceTree& tree)
    {
        trails_.assign(objects, ProxyTrail(model, tree));
        are_joined_.assign(objects, true);
    }

    /// Judges the last frame of the rig, for its only tool.
    void judge(const FrameRig& rig, const FrameOutput& output, const char* activity)
    {
        const ToolOutput& tool = output.tools[0];
        activity_ = activity;
        ++figures_.crossings.trials;
        figures_.in_contact += tool.in_contact ? 1 : 0;
        figures_.halted += tool.halted ? 1 : 0;
        figures_.over_constrained += tool.over_constrained ? 1 : 0;
        figures_.felt_shaded +=
            tool.stiffness_n_per_m > kWall_n_per_m * (1.0 + kStiffnessRounding) ? 1 : 0;
        for (std::size_t object = 0; object < trails_.size(); ++object)
        {
            const ProxyTrail::Crossings found =
                trails_[object].follow(rig.frame().tool(0).path_m(), rig.pose(object));
            if (found.moved)
            {
                flag(figures_.crossings, found.moved->text());
            }
            if (found.carried && are_joined_[object])
            {
                judge_run_over(*found.carried, tool);
            }
        }
        are_joined_.assign(trails_.size(), true);
        for (const PairOutput& pair : output.pairs)
        {
            are_joined_[pair.object] = pair.is_joined;
        }
        const double force = tool.force_n.norm();
        if (!(force <= kForceMax_n + kForceRounding_n) || !tool.proxy_m.allFinite())
        {
            flag(figures_.crossings, "force of " + std::to_string(force) + " N");
        }
        ++frame_;
    }

    void flag(TrialFigures& figures, const std::string& text)
    {
        figures.flag(figures.name + ", TACTUS_SEED=" + std::to_string(seed_) + ", frame " +
                     std::to_string(frame_) + " (" + activity_ + "): " + text);
        figures.observe(static_cast<double>(figures.violations));
    }
    void flag(const std::string& text) { flag(figures_.crossings, text); }

    [[nodiscard]] PopThroughFigures& figures() { return figures_; }

private:
    void judge_run_over(const Crossing& crossing, const ToolOutput& tool)
    {
        ++figures_.run_over.trials;
        if (!tool.over_constrained)
        {
            flag(figures_.run_over, crossing.text());
            flag(figures_.crossings, crossing.text());
        }
    }

    std::uint64_t seed_;
    std::vector<ProxyTrail> trails_;
    /// PairOutput::is_joined of the last frame, by object.
    std::vector<bool> are_joined_;
    PopThroughFigures figures_;
    std::uint64_t frame_{0};
    std::string activity_;
};

RigOptions options_of(const PopThroughTrial& trial, double diagonal_m, Random& random)
{
    RigOptions options = with_tool(trial.hardship.rig, trial.hardship.radius_diag * diagonal_m);
    options.tools[0].shading_m = trial.is_smooth ? any_shading_width_m(random) : 0.0;
    options.faults.seed = trial.seed + 1;
    return options;
}

std::string name_of(const char* what, const TestModel& model, bool is_smooth)
{
    return std::string(what) + (is_smooth ? ", smooth, " : ", ") + model.name;
}

} // namespace

PopThroughFigures run_pop_through_trial(const PopThroughTrial& trial)
{
    Random random = Random::seeded(trial.seed);
    const double diagonal_m = random.between(kSmallest_m, kLargest_m);
    const double scale = diagonal_m / trial.model.diagonal_m;
    RandomMotion motion(trial.model, trial.tree,
                        trial.hardship.radius_diag * trial.model.diagonal_m, scale, random);
    motion.tap_up_to(kFastestTap_m_per_s);
    FrameRig rig(trial.model, options_of(trial, diagonal_m, random));
    PopThroughJudge judge(name_of("pop-through", trial.model, trial.is_smooth) + ", " +
                              trial.hardship.name,
                          trial.seed);
    judge.begin(1, trial.model, trial.tree);
    for (std::uint32_t frame = 0; frame < trial.frames; ++frame)
    {
        const Moment moment = motion.next();
        rig.place_object(moment.pose);
        const FrameOutput output = rig.step(moment.goal_m, trial.hardship.budgets);
        judge.judge(rig, output, motion.activity());
    }
    return judge.figures();
}

namespace
{

/// Two objects on a line through the origin, one on either side, with random rotations. Both
/// approach each other, or one approaches the other, which stays in its open position.
class Jaws
{
public:
    Jaws(const FaceTree& tree, double scale, std::optional<double> stays_m, Random& random)
        : middle_m_(0.5 * (tree.low_m() + tree.high_m()))
        , axis_(random.in_cube(1.0).normalized())
        , stays_m_(stays_m)
    {
        for (ObjectPose& pose : poses_)
        {
            pose.rotation = Eigen::Quaterniond{random.between(0.1, 1.0), random.between(-1.0, 1.0),
                                               random.between(-1.0, 1.0), random.between(-1.0, 1.0)}
                                .normalized()
                                .toRotationMatrix();
            pose.scale = scale;
        }
    }

    /// Places the centres of the objects 2 x `half_gap_m` apart.
    void open_to(double half_gap_m, FrameRig& rig)
    {
        const double first_m = stays_m_.value_or(half_gap_m);
        if (!stays_m_ || !is_placed_)
        {
            place(0, first_m, rig);
        }
        place(1, first_m - 2.0 * half_gap_m, rig);
        is_placed_ = true;
    }

private:
    void place(std::size_t object, double along_m, FrameRig& rig)
    {
        ObjectPose& pose = poses_[object];
        pose.translation_m = along_m * axis_ - pose.scale * (pose.rotation * middle_m_);
        rig.place_object(pose, object);
    }

    Vec3 middle_m_;
    Vec3 axis_;
    std::optional<double> stays_m_;
    bool is_placed_{false};
    std::array<ObjectPose, 2> poses_;
};

/// Tool of a round, which the hand keeps at the origin.
class ClosingRound
{
public:
    ClosingRound(const ClosingTrial& trial, const RigOptions& options, Jaws& jaws,
                 PopThroughJudge& judge)
        : rig_(trial.model, options)
        , safe_(rig_.frame().tool(0).spec(), kPeriod_s)
        , jaws_(jaws)
        , judge_(judge)
    {
        judge_.begin(2, trial.model, trial.tree);
        run_over_before_ = judge_.figures().run_over.trials;
    }

    /// Returns true if the tool is over-constrained.
    bool step(double half_gap_m, const char* activity)
    {
        jaws_.open_to(half_gap_m, rig_);
        const FrameOutput output = rig_.step(Vec3(0.0, 0.0, 0.0));
        const ToolOutput& tool = output.tools[0];
        judge_.judge(rig_, output, activity);
        over_constrained_s_ = tool.over_constrained ? over_constrained_s_ + kPeriod_s : 0.0;
        if (tool.over_constrained != has_fault(output.faults, FrameFault::proxy_over_constrained))
        {
            judge_.flag("the frame's fault and the tool's differ");
        }
        const Vec3 safe_n = safe_.step(tool, Vec3(0.0, 0.0, 0.0));
        if (over_constrained_s_ > kFadeTime_s + kPeriod_s)
        {
            ++judge_.figures().faded;
            if (safe_n.norm() > kForceRounding_n)
            {
                judge_.flag("there is still a force");
            }
        }
        return tool.over_constrained;
    }
    /// Ends the round. A tool that an object ran over may be inside it, in a corner without free
    /// space.
    void end()
    {
        judge_.figures().let_go += over_constrained_s_ > 0.0 ? 0 : 1;
        const bool is_run_over = judge_.figures().run_over.trials > run_over_before_;
        if (over_constrained_s_ > 0.0 && !is_run_over)
        {
            judge_.flag("there is room again, but not for the tool");
        }
    }

private:
    FrameRig rig_;
    SafeForce safe_;
    Jaws& jaws_;
    PopThroughJudge& judge_;
    double over_constrained_s_{0.0};
    std::uint64_t run_over_before_{0};
};

void close_and_open(ClosingRound& round, double open_m, double speed_m_per_s)
{
    for (std::uint32_t frame = 0; frame < kRestFrames; ++frame)
    {
        round.step(open_m, "open");
    }
    double half_gap_m = open_m;
    bool is_over_constrained = false;
    while (half_gap_m > 0.0 && !is_over_constrained)
    {
        half_gap_m -= speed_m_per_s * kPeriod_s;
        is_over_constrained = round.step(half_gap_m, "closing");
    }
    for (std::uint32_t frame = 0; frame < kRestFrames; ++frame)
    {
        round.step(half_gap_m, "closed");
    }
    while (half_gap_m < open_m)
    {
        half_gap_m += speed_m_per_s * kPeriod_s;
        round.step(half_gap_m, "opening");
    }
    for (std::uint32_t frame = 0; frame < kRestFrames; ++frame)
    {
        round.step(open_m, "open again");
    }
    round.end();
}

} // namespace

PopThroughFigures run_closing_trial(const ClosingTrial& trial)
{
    Random random = Random::seeded(trial.seed);
    RigOptions options = hardship_named(trial.model, "usual").rig;
    options.objects = {ObjectSpec{ModelId{0}}, ObjectSpec{ModelId{0}}};
    PopThroughJudge judge(name_of("closing in", trial.model, trial.is_smooth), trial.seed);
    for (std::uint32_t i = 0; i < trial.rounds; ++i)
    {
        const double diagonal_m = random.between(kSmallest_m, kLargest_m);
        const double radius_m = kSqueezedRadius_diag * diagonal_m;
        const double open_m = 0.5 * diagonal_m + 2.0 * radius_m;
        const std::optional<double> stays_m = i % 2 == 1 ? std::optional(open_m) : std::nullopt;
        Jaws jaws(trial.tree, diagonal_m / trial.model.diagonal_m, stays_m, random);
        RigOptions with_sphere = with_tool(options, radius_m);
        with_sphere.tools[0].shading_m = trial.is_smooth ? any_shading_width_m(random) : 0.0;
        ClosingRound round(trial, with_sphere, jaws, judge);
        const double fastest_m_per_s = stays_m ? kFastestJaw_m_per_s : 1.0;
        close_and_open(round, open_m, random.between(0.05, fastest_m_per_s));
    }
    return judge.figures();
}

} // namespace tactus::test
