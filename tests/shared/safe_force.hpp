// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/force/safe_state.hpp"
#include "rt_core/records/frame_output.hpp"

namespace tactus::test
{

/// Force and torque of one tool as they reach its device: the frame's through SafeState.
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
        return both(output, position_m).force_n;
    }

    /// And the torque.
    [[nodiscard]] SafetyOutput both(const ToolOutput& output, const Vec3& position_m)
    {
        SafetyInput input;
        input.position_m = position_m;
        input.elapsed_s = period_s_;
        input.force_n = output.force_n;
        input.torque_nm = output.torque_nm;
        input.proxy_m = output.proxy_m;
        input.faults = faults_of(output);
        return safe_.step(input);
    }

    [[nodiscard]] double gain() const { return safe_.gain(); }

private:
    SafeState safe_;
    double period_s_;
};

} // namespace tactus::test
