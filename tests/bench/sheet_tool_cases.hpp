// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"
#include "tests/bench/cases.hpp"

#include <cstdint>
#include <vector>

namespace tactus::bench
{

/// Corners of a box centred on the origin.
[[nodiscard]] inline std::vector<Vec3> box_corners(const Vec3& half_m)
{
    std::vector<Vec3> corners_m;
    for (std::uint32_t i = 0; i < 8; ++i)
    {
        corners_m.emplace_back((i & 1U) != 0 ? half_m.x() : -half_m.x(),
                               (i & 2U) != 0 ? half_m.y() : -half_m.y(),
                               (i & 4U) != 0 ? half_m.z() : -half_m.z());
    }
    return corners_m;
}

/// Rigid tools that lie, slide and rotate on flat sheets of any cell size, where force and torque
/// are known.
void run_sheet_tools(const CaseContext& context);

/// Tools of a centimetre on dense meshes: how often they have a force, and how accurate it is.
void run_dense_meshes(const CaseContext& context);

} // namespace tactus::bench
