// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"
#include "rt_core/spm/base_mesh.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace tactus
{

/// Tells whether a tool begins inside a solid. The force has no notion of inside: a surface holds a
/// tool on the side where it was first. One that begins within is held there, and a hand that
/// leaves is pulled back. So a program that starts a run asks first.
///
/// Judged by the base mesh, with a margin as wide as its largest error: a place that is nearer to
/// the surface isn't called inside.
///
/// Any thread, but not the haptic one: some microseconds to a millisecond a place.
class InsideTest
{
public:
    /// Of a model that isn't closed, or whose base mesh isn't here, nothing is inside. Of a header
    /// that parses.
    InsideTest(const ModelHeader& header, std::span<const std::byte> base);

    /// A place in the model's frame.
    [[nodiscard]] bool holds(const Vec3& place_m) const;

private:
    [[nodiscard]] bool is_wound_round(const Vec3& place_m) const;

    std::vector<std::array<Vec3, 3>> faces_m_; ///< None: nothing is inside.
    double margin_m_{0.0};
};

} // namespace tactus
