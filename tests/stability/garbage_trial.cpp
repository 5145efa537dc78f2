// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/stability/garbage_trial.hpp"

#include "tests/shared/frame_rig.hpp"
#include "tests/shared/safe_force.hpp"
#include "tests/shared/surface_slide.hpp"
#include "tests/stability/bracket_trial.hpp"
#include "tests/stability/garbage_episodes.hpp"
#include "tests/stability/hardships.hpp"
#include "tests/stability/trial_terms.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace tactus::test
{

namespace
{

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

} // namespace tactus::test
