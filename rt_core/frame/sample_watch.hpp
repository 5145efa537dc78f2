// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/force/tool_goal.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"

#include <cstdint>

namespace tactus
{

/// Stands between one tool's device and the frame: which samples are taken, and what is wrong when
/// they can't be trusted, so that SafeState takes the force away.
///
/// A sample that is not finite, out of range, no rotation or older than the one before is not
/// taken; the goal stays. Neither is one with the time of the one before: a device may be slower
/// than the frame. The last sample stands in for what doesn't come during kSampleHold_s; then the
/// device is stuck. A goal that jumps or turns farther than any hand does is taken, but it is told
/// as a jump until it is so near the proxy that the springs between them are within the device's
/// range: a device that has lost its place must not pull towards where it was. A ball's rotation is
/// nobody's business. Haptic thread.
class SampleWatch
{
public:
    struct Verdict
    {
        bool is_taken{false};
        bool is_first{false}; ///< Nothing is known from before.
        double since_s{0.0};  ///< Since the last sample that was taken; unless it is the first.
        FrameFault fault{FrameFault::none};
    };

    /// Once a frame and tool. `elapsed_s` since the last frame, `goal` of the last taken sample.
    /// After kSampleHold_s + kFadeTime_s without a sample the clock may have begun anew: then an
    /// earlier time is taken.
    [[nodiscard]] Verdict judge(const ToolState& sample, const ToolSpec& spec, const ToolGoal& goal,
                                double elapsed_s) noexcept TACTUS_NONBLOCKING;

    /// After the frame's force is known: a goal that had jumped is back where the springs between
    /// proxy and goal are within the device's range.
    void look_for_return(const ToolOutput& output, const ToolSpec& spec,
                         const ToolGoal& goal) noexcept TACTUS_NONBLOCKING;

    /// What is wrong with the device after this frame: the last verdict's fault, and tool_jumped
    /// until the goal is back where a force may follow it.
    [[nodiscard]] FrameFault fault() const noexcept TACTUS_NONBLOCKING
    {
        return has_lost_place_ ? fault_ | FrameFault::tool_jumped : fault_;
    }

private:
    [[nodiscard]] Verdict take(const ToolState& sample, const ToolSpec& spec, const ToolGoal& goal,
                               double elapsed_s) noexcept;
    [[nodiscard]] bool is_jump(const ToolState& sample, const ToolSpec& spec,
                               const ToolGoal& goal) const noexcept;
    [[nodiscard]] FrameFault find_fault(const ToolState& sample) const noexcept;

    double blind_s_{kInfinity}; ///< Since the last taken sample.
    std::int64_t time_ns_{0};
    bool has_lost_place_{false};
    FrameFault fault_{FrameFault::none}; ///< Of the last verdict.
};

} // namespace tactus
