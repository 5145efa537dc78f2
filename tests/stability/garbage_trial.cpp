// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

#include "tests/stability/garbage_trial.hpp"

#include "host_tools/shapes/shapes.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/rotation.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/period.hpp"
#include "tests/shared/safe_force.hpp"
#include "tests/shared/solid_cores.hpp"
#include "tests/shared/surface_slide.hpp"
#include "tests/stability/bracket_trial.hpp"
#include "tests/stability/hardships.hpp"
#include "tests/stability/trial_terms.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace tactus::test
{
namespace
{

/// Frames of 1 ms: kSampleHold_s; kFadeTime_s with one more on either side; and the recovery of a
/// tool.
inline constexpr std::uint32_t kHeldFrames = 20;

inline constexpr std::uint32_t kGoneFrames = 72;

inline constexpr std::uint32_t kRecoveryFrames = 200;

/// Episodes in which a device sends garbage, for some frames or until all force is gone, each
/// followed by a long sound period in which everything must recover. Begins sound. Checks every
/// tool meanwhile.
class GarbageEpisodes
{
public:
    /// Starts with `figures`, which have the name and must outlive this object.
    GarbageEpisodes(const Garbage& garbage, std::uint64_t seed, TrialFigures& figures)
        : garbage_(garbage), seed_(seed), figures_(figures), random_(Random::seeded(seed))
    {
    }

    /// Sample of the device in the next frame, for a true sample of the hand.
    [[nodiscard]] ToolState next(ToolState sample)
    {
        ++frame_;
        if (frames_left_ == 0)
        {
            in_episode_ = frame_ > 1 && !in_episode_;
            const std::uint32_t episode =
                random_.one_in(2) ? 1 + random_.below(5) : kGoneFrames + 20;
            frames_left_ = in_episode_ ? episode : kRecoveryFrames + 50;
            age_ = 0;
        }
        --frames_left_;
        ++age_;
        if (in_episode_)
        {
            garbage_.spoil(sample, good_, random_);
            return sample;
        }
        good_ = sample;
        return sample;
    }

    /// Checks that the fault is reported, that the force ends without a sample, and that the tool's
    /// faults end too.
    void check(const FrameOutput& output, bool has_force)
    {
        const auto tells = [&](FrameFault fault)
        { return fault == FrameFault::none || has_fault(output.faults, fault); };
        if (in_episode_)
        {
            expect(age_ > 1 || tells(garbage_.fault), "the first frame tells no fault");
            expect(age_ <= kHeldFrames || tells(garbage_.lasting_fault),
                   "no fault is told any more");
            expect(!garbage_.fades || age_ < kGoneFrames || !has_force,
                   "there is force without a sample");
        }
        else if (is_recovered())
        {
            constexpr FrameFault kOfTool =
                FrameFault::tool_invalid | FrameFault::tool_stuck | FrameFault::tool_jumped;
            expect(!has_fault(output.faults, kOfTool), "the tool's faults don't end");
        }
    }
    /// True long after an episode, with sound samples.
    [[nodiscard]] bool is_recovered() const
    {
        return !in_episode_ && frame_ > kRecoveryFrames && age_ >= kRecoveryFrames;
    }
    [[nodiscard]] bool is_one() const { return in_episode_; }

    void expect(bool holds, const std::string& otherwise)
    {
        if (!holds)
        {
            figures_.flag(figures_.name + ", TACTUS_SEED=" + std::to_string(seed_) + ", frame " +
                          std::to_string(frame_ - 1) + ", " + std::to_string(age_) +
                          (in_episode_ ? " into an episode: " : " after an episode: ") + otherwise);
        }
    }

private:
    const Garbage& garbage_;
    std::uint64_t seed_;
    TrialFigures& figures_;
    Random random_;
    ToolState good_; ///< Last sound sample.
    std::uint32_t frame_{0};
    std::uint32_t age_{0}; ///< Frames of this episode, or since it.
    std::uint32_t frames_left_{0};
    bool in_episode_{false};
};

constexpr std::int64_t kFrame_ns = 1'000'000;
constexpr double kPressed = 0.7;
constexpr double kForceRounding = 1e-15;

Vec3 with_one(const Vec3& place, Random& random, double value)
{
    Vec3 spoilt = place;
    spoilt[random.below(3)] = value;
    return spoilt;
}

using Limits = std::numeric_limits<double>;

void spoil_not_a_number(ToolState& sample, const ToolState& /*good*/, Random& random)
{
    if (random.one_in(2))
    {
        const std::uint32_t row = random.below(3);
        sample.rotation(row, random.below(3)) = Limits::quiet_NaN();
        return;
    }
    sample.position_m = with_one(sample.position_m, random, Limits::quiet_NaN());
}
void spoil_infinite(ToolState& sample, const ToolState& /*good*/, Random& random)
{
    const double sign = random.one_in(2) ? 1.0 : -1.0;
    sample.position_m = with_one(sample.position_m, random, sign * Limits::infinity());
}
void spoil_huge(ToolState& sample, const ToolState& /*good*/, Random& random)
{
    sample.position_m = with_one(sample.position_m, random, Limits::max());
}
void spoil_invalid(ToolState& sample, const ToolState& /*good*/, Random& /*random*/)
{
    sample.valid = false;
}
/// Another jump in each frame.
void spoil_jump(ToolState& sample, const ToolState& good, Random& random)
{
    sample.position_m = good.position_m + 10.0 * random.in_cube(1.0).normalized();
}
void spoil_stuck(ToolState& sample, const ToolState& good, Random& /*random*/)
{
    sample = good;
}
void spoil_backwards(ToolState& sample, const ToolState& good, Random& random)
{
    sample.sample_time_ns =
        good.sample_time_ns - 1 - static_cast<std::int64_t>(random.below(kFrame_ns));
}
void spoil_denormal(ToolState& sample, const ToolState& good, Random& random)
{
    sample.position_m = with_one(good.position_m, random, Limits::denorm_min());
}
void spoil_all(ToolState& sample, const ToolState& good, Random& random)
{
    const std::array spoilers{spoil_not_a_number, spoil_infinite, spoil_huge, spoil_invalid,
                              spoil_backwards};
    spoilers[random.below(spoilers.size())](sample, good, random);
}

/// One tool with its device and the state of the episode.
class GarbageRun
{
public:
    GarbageRun(const TestModel& model, const CenterOracle& oracle, const Garbage& garbage,
               std::uint64_t seed)
        : oracle_(oracle)
        , slide_(oracle.tree(), manner_of(model), start_of(oracle.tree(), model))
        , rig_(model, with_tool({}, kRadius_diag * model.diagonal_m))
        , safe_(rig_.frame().tool(0).spec(), 1e-9 * static_cast<double>(kFrame_ns))
        , episodes_(garbage, seed, figures_)
    {
        figures_.name = model.name + ", " + garbage.name;
        figures_.unit = "of the largest force";
        figures_.bound = 1.0 + kForceRounding;
    }

    [[nodiscard]] TrialFigures run(std::uint32_t frames)
    {
        for (std::uint32_t frame = 0; frame < frames; ++frame)
        {
            ToolState hand;
            hand.position_m = slide_.next();
            hand.sample_time_ns = kFrame_ns * (frame + 1'000);
            const ToolState sample = episodes_.next(hand);
            check(rig_.step(std::span(&sample, 1), {}), sample.position_m);
        }
        return figures_;
    }

private:
    static SlideManner manner_of(const TestModel& model)
    {
        SlideManner manner;
        manner.diagonal_m = model.diagonal_m;
        // The tool is always in contact, so that there is force.
        manner.radius_diag = kPressed * kRadius_diag;
        manner.step_m = 0.1e-3 * model.diagonal_m;
        manner.rotation_rate = [](std::uint64_t turn) { return turn % 2 == 0 ? 0.5 : -0.5; };
        return manner;
    }
    static Vec3 start_of(const FaceTree& tree, const TestModel& model)
    {
        return tree.nearest(tree.high_m()).point_m +
               Vec3(0.0, 0.0, kRadius_diag * model.diagonal_m);
    }

    void check(const FrameOutput& output, const Vec3& position_m)
    {
        ++figures_.trials;
        const ToolOutput& tool = output.tools[0];
        const double force_n = safe_.step(tool, position_m).norm();
        figures_.observe(force_n / kForceMax_n);
        const double most_n = std::max(force_n, tool.force_n.norm());
        episodes_.expect(std::isfinite(most_n) && most_n <= kForceMax_n * (1.0 + kForceRounding),
                         "the force is " + std::to_string(most_n) + " N");
        episodes_.expect(tool.proxy_m.allFinite(), "the proxy is nowhere");
        const PairOutput& pair = output.pairs[0];
        const BracketVerdict verdict = judge_bracket(oracle_, pair, rig_.pose());
        episodes_.expect(verdict.error <= 1.0, verdict.text);
        const bool has_jumped =
            episodes_.is_one() && has_fault(output.faults, FrameFault::tool_jumped);
        episodes_.expect(!has_jumped || force_n < kForceMax_n, "a jump pulls with all force");
        const bool is_answered =
            pair.kind == AnswerKind::exact || pair.kind == AnswerKind::separated;
        episodes_.expect(!episodes_.is_recovered() || is_answered,
                         "no answer long after the episode");
        episodes_.check(output, force_n != 0.0);
    }

    const CenterOracle& oracle_;
    SurfaceSlide slide_;
    FrameRig rig_;
    SafeForce safe_;
    TrialFigures figures_;
    GarbageEpisodes episodes_;
};

} // namespace

const std::array<Garbage, kGarbageKinds>& garbage_kinds()
{
    using enum FrameFault;
    static const std::array<Garbage, kGarbageKinds> kinds{{
        {"not a number", spoil_not_a_number, tool_invalid, tool_invalid, true},
        {"infinite", spoil_infinite, tool_invalid, tool_invalid, true},
        {"1.8e308 m", spoil_huge, tool_invalid, tool_invalid, true},
        {"said to be invalid", spoil_invalid, tool_invalid, tool_invalid, true},
        {"jumps of 10 m", spoil_jump, tool_jumped, tool_jumped},
        {"stuck", spoil_stuck, none, tool_stuck, true},
        {"time backwards", spoil_backwards, tool_invalid, none},
        {"denormals", spoil_denormal, none, none},
        {"all of it", spoil_all, tool_invalid, none},
    }};
    return kinds;
}

TrialFigures run_garbage_trial(const TestModel& model, const CenterOracle& oracle,
                               const Garbage& garbage, std::uint32_t frames, std::uint64_t seed)
{
    return GarbageRun(model, oracle, garbage, seed).run(frames);
}

namespace
{

constexpr std::int64_t kGarbageFrame_ns = 1'000'000;
constexpr double kToolForceMax_n = 8.0;
constexpr double kToolTorqueMax_nm = 0.3;
constexpr double kGarbageRounding = 1e-12;
/// Greatest change per frame that ForceFader permits while fading and returning.
constexpr double kMostOfRange = kPeriod_s / kFadeTime_s + 2.0 * kPeriod_s / kRiseTime_s;
constexpr double kSecondTurn_rad =
    1.5; ///< Greater than kJumpRotation_rad_per_s permits in a frame.

Mat3 turned_about(const Vec3& axis, double angle_rad)
{
    return turned_by(axis.normalized() * angle_rad, Mat3::Identity());
}

void spoil_rotation(ToolState& sample, const ToolState& /*good*/, Random& random)
{
    const std::array<double, 4> factors{0.0, -1.0, 1.001, 1e200};
    sample.rotation *= factors[random.below(factors.size())];
}
/// Another rotation in each frame.
void spoil_turns(ToolState& sample, const ToolState& /*good*/, Random& random)
{
    const Vec3 axis = random.in_cube(1.0) + Vec3(0, 0, 1e-3);
    sample.rotation = turned_about(axis, random.between(kSecondTurn_rad, 3.0)) * sample.rotation;
}
void spoil_turned(ToolState& sample, const ToolState& /*good*/, Random& /*random*/)
{
    sample.rotation = turned_about(Vec3(1.0, 0.5, 0.2), kSecondTurn_rad) * sample.rotation;
}

/// Run of a box, 4 cm long, on a plate of 10 cm whose top is at the height of its highest corner.
class RigidGarbageRun
{
public:
    RigidGarbageRun(const Garbage& garbage, std::uint64_t seed)
        : model_(test_model("rigid-small-flat", make_shape(Shape::plate, 400).value(), 60))
        , box_(box_core("box", Vec3(0.02, 0.015, 0.004), 0.001))
        , rig_({&model_}, options())
        , safe_(rig_.frame().tool(0).spec(), kPeriod_s)
        , episodes_(garbage, seed, figures_)
    {
        figures_.name = "box on a plate, " + std::string(garbage.name);
        figures_.unit = "of the largest force or torque";
        figures_.bound = 1.0 + kGarbageRounding;
        center_ = rig_.frame().tool(0).sphere().center;
        for (const Face& face : model_.faces)
        {
            for (const Vec3f& corner : face)
            {
                low_ = least_of(low_, to_vec3(corner));
                high_ = greatest_of(high_, to_vec3(corner));
            }
        }
    }

    [[nodiscard]] TrialFigures run(std::uint32_t frames)
    {
        for (frame_ = 0; frame_ < frames; ++frame_)
        {
            const ToolState sample = episodes_.next(hand());
            check(rig_.step(std::span(&sample, 1), {}), sample.position_m);
        }
        return figures_;
    }

private:
    static RigOptions options()
    {
        RigOptions options;
        options.pool_bytes = std::size_t{32} << 20U;
        ToolSpec spec;
        spec.radius_m = 0.001;
        spec.core = Box{Vec3(0.02, 0.015, 0.004)};
        spec.force_max_n = kToolForceMax_n;
        spec.torque_max_nm = kToolTorqueMax_nm;
        options.tools = {spec};
        Material rough;
        rough.static_friction = 0.3;
        rough.dynamic_friction = 0.2;
        options.objects = {{ModelId{0}, rough}};
        return options;
    }

    /// Hand pose 2 mm too deep, on a circle, rotating about the plate's normal and rocking; from
    /// above at first.
    [[nodiscard]] ToolState hand() const
    {
        const double t = kPeriod_s * frame_;
        const double rest_m = high_.z() + 0.005;
        ToolState state;
        state.position_m = Vec3(0.5 * (low_.x() + high_.x()) + 0.01 * std::cos(3.0 * t),
                                0.5 * (low_.y() + high_.y()) + 0.01 * std::sin(3.0 * t),
                                rest_m + std::max(-0.002, 0.02 - 0.2 * t));
        state.rotation = turned_about(Vec3(1, 0, 0), 0.05 * std::sin(5.0 * t)) *
                         turned_about(Vec3(0, 0, 1), 0.8 * t);
        state.sample_time_ns = kGarbageFrame_ns * (frame_ + 1'000);
        return state;
    }

    void check(const FrameOutput& output, const Vec3& position_m)
    {
        ++figures_.trials;
        const ToolOutput& tool = output.tools[0];
        const ToolForce safe = safe_.both(tool, position_m);
        for (const auto& [norm, most] : {std::pair(tool.force_n.norm(), kToolForceMax_n),
                                         std::pair(tool.torque_nm.norm(), kToolTorqueMax_nm),
                                         std::pair(safe.push.force_n.norm(), kToolForceMax_n),
                                         std::pair(safe.torque.force_n.norm(), kToolTorqueMax_nm)})
        {
            figures_.observe(std::isfinite(norm) ? norm / most : kInfinity);
            expect(norm <= most * (1.0 + kGarbageRounding), std::to_string(norm) + " N or N m");
        }
        if (safe_.gain() < 1.0 && !tool.halted && !tool.over_constrained)
        {
            expect((safe.push.force_n - sent_.push.force_n).norm() <=
                       kMostOfRange * kToolForceMax_n + kGarbageRounding,
                   "the force jumps");
            expect((safe.torque.force_n - sent_.torque.force_n).norm() <=
                       kMostOfRange * kToolTorqueMax_nm + kGarbageRounding,
                   "the torque jumps");
        }
        sent_ = safe;
        const Similarity now{tool.proxy_rotation, tool.proxy_m, 1.0};
        expect(now.translation_m.allFinite() && now.rotation.allFinite(), "the proxy is nowhere");
        expect(frame_ == 0 || crossings_on_way(box_, place_, now, center_, model_, 2) == 0,
               "the box goes through");
        place_ = now;
        expect(!episodes_.is_recovered() || (tool.in_contact && sent_.push.force_n.norm() > 0.5),
               "nothing is felt again");
        episodes_.check(output,
                        sent_.push.force_n.norm() > 0.0 || sent_.torque.force_n.norm() > 0.0);
    }

    void expect(bool holds, const std::string& otherwise) { episodes_.expect(holds, otherwise); }

    const TestModel& model_;
    SolidCore box_;
    FrameRig rig_;
    SafeForce safe_;
    TrialFigures figures_;
    ToolForce sent_;
    Similarity place_;
    Vec3 center_{0, 0, 0};
    Vec3 low_{1e9, 1e9, 1e9};
    Vec3 high_{-1e9, -1e9, -1e9};
    std::uint32_t frame_{0};
    GarbageEpisodes episodes_;
};

} // namespace

std::span<const Garbage> rigid_garbage_kinds()
{
    using enum FrameFault;
    static const auto kinds = []
    {
        std::array<Garbage, kGarbageKinds + 3> all{};
        std::ranges::copy(garbage_kinds(), all.begin());
        all[kGarbageKinds] = {"no rotation", spoil_rotation, tool_invalid, tool_invalid, true};
        all[kGarbageKinds + 1] = {"turns of 1.5 to 3 rad", spoil_turns, tool_jumped, none, false};
        all[kGarbageKinds + 2] = {"a turn that stays", spoil_turned, tool_jumped, none, false};
        return all;
    }();
    return kinds;
}

TrialFigures run_rigid_garbage_trial(const Garbage& garbage, std::uint32_t frames,
                                     std::uint64_t seed)
{
    return RigidGarbageRun(garbage, seed).run(frames);
}

} // namespace tactus::test
