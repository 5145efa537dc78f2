// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"
#include "rt_core/records/frame_output.hpp"

#include <span>

namespace tactus::hrtc
{

/// Shares `push_n`, by which a tool of that radius pushes all that it touches, among the objects of
/// its pairs, world frame: what is off by less than 1 mm and
/// lies in the push's direction counts as touched. Each gets the part that
/// fits its normal best, none pulls, and what no normals explain (friction) goes with it in
/// proportion; the sum is `push_n`. Where one object is touched it gets all of it. One result a
/// pair. Allocates nothing; 0.02 us for one touched object, 0.2 us for several.
void share_push(std::span<const PairOutput> pairs, double radius_m, const Vec3& push_n,
                std::span<Vec3> pushes_n) noexcept;

} // namespace tactus::hrtc
