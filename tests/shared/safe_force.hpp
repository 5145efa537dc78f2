// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/force/force_fader.hpp"
#include "rt_core/records/frame_output.hpp"

namespace tactus::test
{

/// Force and torque of one tool as its device gets them: the frame's through ForceFader.
class SafeForce
{
public:
    SafeForce(const ToolSpec& tool, double period_s)
        : safe_({1e9, tool.force_max_n, tool.stiffness_n_per_m, 0.0, tool.torque_max_nm})
        , period_s_(period_s)
    {
    }

    [[nodiscard]] Vec3 step(const ToolOutput& output, const Vec3& position_m)
    {
        return both(output, position_m).push.force_n;
    }

    /// Force and torque of one step.
    [[nodiscard]] ToolForce both(const ToolOutput& output, const Vec3& position_m)
    {
        ToolForce force;
        force.push.force_n = output.force_n;
        force.torque.force_n = output.torque_nm;
        ToolPeriod period;
        period.device_m = position_m;
        period.elapsed_s = period_s_;
        period.stretch_m = (output.proxy_m - position_m).norm();
        period.faults = faults_of(output);
        safe_.step(force, period);
        return force;
    }

    [[nodiscard]] double gain() const { return safe_.gain(); }

private:
    ForceFader safe_;
    double period_s_;
};

} // namespace tactus::test
