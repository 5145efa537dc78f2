// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/math/similarity.hpp"
#include "transport/base/refusal.hpp"

#include <string_view>

namespace tactus::hrtc
{

/// Parses X,Y,Z[,RX,RY,RZ[,SCALE]]: the pose in the world of an object's or device's source frame.
/// X,Y,Z is the translation in metres, RX,RY,RZ the rotation vector (axis times angle) in degrees,
/// and SCALE the scale.
[[nodiscard]] Result<Similarity, Refusal> parse_placement(std::string_view text);

} // namespace tactus::hrtc
