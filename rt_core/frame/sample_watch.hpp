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

/// Checks the samples of one tool's device: decides which are taken, and reports a fault if they
/// can't be trusted, so that ForceFader fades the force.
///
/// A sample that is not finite, out of range, no rotation or older than the one before is not
/// taken; the goal stays. A sample with the time of the one before is not taken either: a device
/// may be slower than the frame. The last sample replaces missing ones for kSampleHold_s; then the
/// device is stuck. A goal that jumps or rotates farther than a user can is taken, but reported as
/// a jump. The jump ends when the springs between goal and proxy are within the device's range: a
/// device that lost its place must not pull towards the old one. A sphere's rotation is ignored.
/// Haptic thread.
class SampleWatch
{
public:
    struct Verdict
    {
        bool is_taken{false};
        bool is_first{false}; ///< No earlier sample exists.
        /// Time since the last sample taken; undefined for the first.
        double since_s{0.0};
        FrameFault fault{FrameFault::none};
    };

    /// Judges a sample, once per frame and tool. `elapsed_s` is the time since the last frame,
    /// `goal` that of the last sample taken. After kSampleHold_s + kFadeTime_s without a sample the
    /// device's clock may have restarted: then an earlier time is taken.
    [[nodiscard]] Verdict judge(const ToolState& sample, const ToolSpec& spec,
                                const ProxyGoal& goal,
                                double elapsed_s) noexcept TACTUS_NONBLOCKING;

    /// Ends a jump if the springs between proxy and goal are within the device's range; called once
    /// the frame's force is known.
    void look_for_return(const ToolOutput& output, const ToolSpec& spec,
                         const ProxyGoal& goal) noexcept TACTUS_NONBLOCKING;

    /// Fault of the device after this frame: that of the last verdict, and tool_jumped until a
    /// force may follow the goal.
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
