// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/force/safe_state.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"

#include <cstddef>
#include <span>

namespace tactus::hrtc
{

/// Notices when an object moves so far in one frame that the spring of a tool in contact would
/// change by more than the device's largest force. No surface that a hand holds on to moves like
/// that. One for each tool; haptic thread; allocates nothing.
class JumpWatch
{
public:
    explicit JumpWatch(const SafetyLimits& limits) noexcept
        : step_max_m_(limits.force_max_n / limits.stiffness_n_per_m)
    {
    }

    /// At the start of a frame: where the objects stood in the frame before, and stand now.
    void see(std::span<const ObjectPose> before, std::span<const ObjectPose> now) noexcept
    {
        has_jumped_ = false;
        for (std::size_t i = 0; i < now.size() && in_contact_; ++i)
        {
            const Vec3 along_m = to_world(now[i], to_model(before[i], proxy_m_));
            has_jumped_ = has_jumped_ || (along_m - proxy_m_).norm() > step_max_m_;
        }
    }

    /// At its end.
    void remember(const ToolOutput& output) noexcept
    {
        in_contact_ = output.in_contact;
        proxy_m_ = output.proxy_m;
    }

    /// Whether an object has jumped in this frame.
    [[nodiscard]] bool has_jumped() const noexcept { return has_jumped_; }

private:
    double step_max_m_;
    Vec3 proxy_m_{0.0, 0.0, 0.0};
    bool in_contact_{false};
    bool has_jumped_{false};
};

} // namespace tactus::hrtc
