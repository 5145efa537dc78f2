// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/force/safe_state.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"

#include <span>
#include <vector>

namespace tactus::hrtc
{

/// Sees when an object goes so far in one frame that the spring of a tool in touch would change by
/// more than the device's largest force: no surface that a hand holds on to moves so. For the
/// haptic thread; allocates nothing after construction.
class JumpWatch
{
public:
    JumpWatch(std::span<const SafetyLimits> limits, std::span<const ObjectPose> poses)
        : poses_(poses.begin(), poses.end())
    {
        for (const SafetyLimits& limit : limits)
        {
            tools_.push_back({limit.force_max_n / limit.stiffness_n_per_m});
        }
    }

    /// At the start of a frame, which will have these poses.
    void see(std::span<const ObjectPose> poses) noexcept
    {
        for (Tool& tool : tools_)
        {
            tool.has_jumped = false;
            for (std::size_t i = 0; i < poses.size() && tool.in_contact; ++i)
            {
                const Vec3 along_m = to_world(poses[i], to_model(poses_[i], tool.proxy_m));
                tool.has_jumped =
                    tool.has_jumped || (along_m - tool.proxy_m).norm() > tool.step_max_m;
            }
        }
        for (std::size_t i = 0; i < poses.size(); ++i)
        {
            poses_[i] = poses[i];
        }
    }

    /// At its end.
    void remember(const FrameOutput& output) noexcept
    {
        for (std::size_t i = 0; i < tools_.size(); ++i)
        {
            tools_[i].in_contact = output.tools[i].in_contact;
            tools_[i].proxy_m = output.tools[i].proxy_m;
        }
    }

    /// In this frame, under this tool.
    [[nodiscard]] bool has_jumped(std::size_t tool) const noexcept
    {
        return tools_[tool].has_jumped;
    }

private:
    struct Tool
    {
        double step_max_m{0.0};
        Vec3 proxy_m{0.0, 0.0, 0.0};
        bool in_contact{false};
        bool has_jumped{false};
    };

    std::vector<ObjectPose> poses_; ///< Of the frame before.
    std::vector<Tool> tools_;
};

} // namespace tactus::hrtc
