// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/math/similarity.hpp"
#include "transport/base/refusal.hpp"

#include <string_view>

namespace tactus::hrtc
{

/// Where the source frame of an object, or a device, lies in the world: translation in metres, a
/// rotation vector (axis times angle) in degrees, scale: X,Y,Z[,RX,RY,RZ[,SCALE]].
[[nodiscard]] Result<Similarity, Refusal> parse_placement(std::string_view text);

} // namespace tactus::hrtc
