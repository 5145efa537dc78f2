// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/tool_port.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <string>
#include <string_view>

namespace tactus::hrtc
{

/// Kind of a virtual fixture (Rosenberg 1993), which guides a hand; the world's frame.
enum class FixtureKind : std::uint8_t
{
    point,   ///< Pulled to it.
    line,    ///< Pulled to it, free along it.
    plane,   ///< Kept on its front side: free there, pushed back from behind it.
    gripper, ///< The hand is free; its gripper is held so far open.
};

/// What --fixture says of one tool.
struct FixtureChoice
{
    std::string words; ///< As they were given.
    FixtureKind kind{FixtureKind::point};
    Vec3 at_m{0.0, 0.0, 0.0};      ///< The point, or one of the line or plane; of a gripper x is
                                   ///< its opening.
    Vec3 direction{0.0, 0.0, 1.0}; ///< Of the line, or the plane's normal; unit length.
    double stiffness_n_per_m{100.0};
    double force_max_n{1.0};
};

/// point:X,Y,Z[,K[,F]], line:X,Y,Z,DX,DY,DZ[,K[,F]], plane:X,Y,Z,NX,NY,NZ[,K[,F]] or
/// gripper:X[,K[,F]], in metres; D and N are a line's direction and a plane's normal, of any
/// length.
[[nodiscard]] Result<FixtureChoice, Refusal> parse_fixture(std::string_view text);

/// A spring of limited force that guides a tool. It has no more energy than what stretches it, so
/// it makes none. It tells its stiffness, so that cap and passivity take it as a wall's.
///
/// Where the device says no place or opening, the fixture stays as it was: ForceFader fades the
/// force then.
///
/// Haptic thread; create it before the loop. Allocates nothing.
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
