// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/choices/fixture_choice.hpp"
#include "platform/loop/tool_port.hpp"
#include "rt_core/math/vec3.hpp"

namespace tactus::hrtc
{

/// Spring of limited force that guides a tool. The spring returns no more energy than the work that
/// stretched it, so it is passive. It reports its stiffness, so the stiffness limit and passivity
/// controller treat it as a wall.
///
/// If the device reports no position or opening, the last force stays. ForceFader fades it then.
///
/// Haptic thread. Create it before the loop. Allocates nothing.
class VirtualFixture final : public ExternalForceSource
{
public:
    explicit VirtualFixture(const FixtureChoice& choice) noexcept;

    [[nodiscard]] ExternalForce next(const DeviceSample& sample, const ToolState& tool,
                                     const ToolOutput& output) noexcept override;

private:
    [[nodiscard]] ExternalForce grip(double open_m) const noexcept;
    [[nodiscard]] Vec3 nearest_allowed(const Vec3& place_m) const noexcept;

    FixtureKind kind_;
    Vec3 at_m_;
    Vec3 direction_;
    double stiffness_n_per_m_;
    double force_max_n_;
    ExternalForce last_;
};

} // namespace tactus::hrtc
