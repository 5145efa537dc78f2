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

/// Tests whether a tool begins inside a solid. A surface holds a tool on the side of its first
/// contact, so a tool that begins inside is held inside and pulls the hand back. A program
/// therefore tests before a run.
///
/// The test uses the base mesh with a margin of its largest error: a place within the margin of the
/// surface does not count as inside.
///
/// Any thread except the haptic one; a test takes microseconds to a millisecond.
class InsideTest
{
public:
    /// `header` must parse, and `base` is its coded base mesh. If the model is not closed or `base`
    /// is empty, holds() is always false.
    InsideTest(const ModelHeader& header, std::span<const std::byte> base);

    /// True if the point, in metres in the model's frame, is inside by more than the margin.
    [[nodiscard]] bool holds(const Vec3& place_m) const;

private:
    [[nodiscard]] bool is_wound_round(const Vec3& place_m) const;

    /// Faces of the base mesh; empty if holds() is always false.
    std::vector<std::array<Vec3, 3>> faces_m_;
    double margin_m_{0.0};
};

} // namespace tactus
