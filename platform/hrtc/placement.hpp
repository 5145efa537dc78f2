// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/limits.hpp"
#include "rt_core/math/similarity.hpp"

#include <optional>
#include <string_view>

namespace tactus::hrtc
{

/// What parse_placement() takes; for messages.
inline constexpr std::string_view kPlacementForm =
    "X,Y,Z[,RX,RY,RZ[,SCALE]] with at most 1e4 m, 360 "
    "degrees and a scale of 1e-3 to 1e3";
static_assert(kPoseReachMax_m == 1e4 && kPoseScaleMin == 1e-3 && kPoseScaleMax == 1e3);

/// Where the source frame of an object, or a device, lies in the world: translation in metres, a
/// rotation vector (axis times angle) in degrees, scale. None when the text is not of that form.
[[nodiscard]] std::optional<Similarity> parse_placement(std::string_view text);

} // namespace tactus::hrtc
