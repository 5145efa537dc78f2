// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/force/proxy_goal.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"

#include <cstdint>

namespace tactus
{

/// Checks the samples of one tool's device: decides which are taken as the goal, and reports a
/// fault for those that can't be trusted, for which ForceFader fades the force.
///
/// A sample is not taken if it is not finite, out of range, no rotation, or older than the last
/// one; the goal stays. A sample with the time of the last one is not taken either, as a device may
/// be slower than the frame. The last sample replaces missing ones for kSampleHold_s; then the
/// device is stuck.
///
/// A goal that moves or rotates farther than a user can is taken, but reported as a jump. The jump
/// ends when the springs between goal and proxy are within the device's range, so that the device
/// does not pull towards the old place. A sphere's rotation is not checked for jumps. Haptic
/// thread.
class SampleWatch
{
public:
    struct Verdict
    {
        bool is_taken{false};
        bool is_first{false}; ///< True if no sample was taken before.
        /// Time since the last sample taken; undefined for the first.
        double since_s{0.0};
        FrameFault fault{FrameFault::none};
    };

    /// Judges a sample, once per frame and tool. `elapsed_s` is the time since the last frame,
    /// `goal` that of the last sample taken. After kSampleHold_s + kFadeTime_s without a sample,
    /// one with an earlier time is taken: the device's clock may have restarted.
    [[nodiscard]] Verdict judge(const ToolState& sample, const ToolSpec& spec,
                                const ProxyGoal& goal,
                                double elapsed_s) noexcept TACTUS_NONBLOCKING;

    /// Ends a jump if the springs between proxy and goal are within the device's range; called once
    /// the force of the frame is known.
    void look_for_return(const ToolOutput& output, const ToolSpec& spec,
                         const ProxyGoal& goal) noexcept TACTUS_NONBLOCKING;

    /// Fault of the device after this frame: the last verdict's, and tool_jumped until the jump has
    /// ended.
    [[nodiscard]] FrameFault fault() const noexcept TACTUS_NONBLOCKING
    {
        return has_lost_place_ ? fault_ | FrameFault::tool_jumped : fault_;
    }

private:
    [[nodiscard]] Verdict take(const ToolState& sample, const ToolSpec& spec, const ProxyGoal& goal,
                               double elapsed_s) noexcept;
    [[nodiscard]] bool is_jump(const ToolState& sample, const ToolSpec& spec,
                               const ProxyGoal& goal) const noexcept;
    [[nodiscard]] FrameFault find_fault(const ToolState& sample) const noexcept;

    double blind_s_{kInfinity}; ///< Time since the last sample taken.
    std::int64_t time_ns_{0};
    bool has_lost_place_{false};
    FrameFault fault_{FrameFault::none}; ///< Fault of the last verdict.
};

} // namespace tactus
