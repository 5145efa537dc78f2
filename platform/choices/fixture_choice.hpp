// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/math/vec3.hpp"
#include "transport/base/refusal.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace tactus::hrtc
{

/// Kind of a virtual fixture (Rosenberg 1993), which guides a hand. Coordinates are the world's.
enum class FixtureKind : std::uint8_t
{
    point,   ///< Pulls the tool to the point.
    line,    ///< Pulls the tool to the line; leaves it free along the line.
    plane,   ///< Pushes the tool back from behind the plane; leaves it free in front.
    gripper, ///< Holds the gripper at an opening; leaves the hand free.
};

/// Virtual fixture of one tool, as given by --fixture.
struct FixtureChoice
{
    std::string words; ///< Text as given.
    FixtureKind kind{FixtureKind::point};
    /// Point, or a point on the line or plane. The x of a gripper fixture is its opening.
    Vec3 at_m{0.0, 0.0, 0.0};
    Vec3 direction{0.0, 0.0, 1.0}; ///< Direction of the line, or normal of the plane; unit length.
    double stiffness_n_per_m{100.0};
    double force_max_n{1.0};
};

/// Parses point:X,Y,Z[,K[,F]], line:X,Y,Z,DX,DY,DZ[,K[,F]], plane:X,Y,Z,NX,NY,NZ[,K[,F]] or
/// gripper:X[,K[,F]], in metres. D is a line's direction and N a plane's normal, both of any
/// length.
[[nodiscard]] Result<FixtureChoice, Refusal> parse_fixture(std::string_view text);

} // namespace tactus::hrtc
