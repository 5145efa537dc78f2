// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/zone.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <string>
#include <string_view>

namespace tactus
{

/// Limits of a zone's coordinates and radius, in metres.
inline constexpr double kMaxZoneCoordinate_m = 1e9;
inline constexpr double kMinZoneRadius_m = 1e-9;

/// Reads sphere:x,y,z,r or box:x0,y0,z0,x1,y1,z1. Numbers are plain decimals without spaces; a
/// box's second corner must not be below its first on any axis.
[[nodiscard]] Result<Zone, Refusal> parse_zone(std::string_view text);

} // namespace tactus
