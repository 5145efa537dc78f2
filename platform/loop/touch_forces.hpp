// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"
#include "rt_core/records/frame_output.hpp"

#include <span>

namespace tactus::hrtc
{

/// Shares `push_n`, the push of one tool on all objects, among the objects of its pairs; world
/// frame. `radius_m`: the tool's radius. Objects within 1 mm of the tool, in the push's direction,
/// count as touched. Each gets the part that fits its normal best, none pulls, and the rest
/// (friction) is shared in proportion. If none counts, the nearest object gets all. `pushes_n` gets
/// one push a pair, 0 without touch; their sum is `push_n`. Allocates nothing; 0.02 us for one
/// touched object, 0.2 us for several.
void share_push(std::span<const PairOutput> pairs, double radius_m, const Vec3& push_n,
                std::span<Vec3> pushes_n) noexcept;

} // namespace tactus::hrtc
