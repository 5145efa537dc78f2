// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"
#include "rt_core/records/frame_output.hpp"

#include <span>

namespace tactus::hrtc
{

/// Shares `push_n`, the push of a tool of that radius on all objects that it touches, among the
/// objects of its pairs, world frame. Objects less than 1 mm off in the push's direction count as
/// touched. Each gets the part that fits its normal best, none pulls, and the rest (friction) is
/// shared in proportion; the sum is `push_n`. A single touched object gets all. One result a pair.
/// Allocates nothing; 0.02 us for one touched object, 0.2 us for several.
void share_push(std::span<const PairOutput> pairs, double radius_m, const Vec3& push_n,
                std::span<Vec3> pushes_n) noexcept;

} // namespace tactus::hrtc
