// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/query/other_surface.hpp"
#include "tests/unit/rt_core/support.hpp"
#include "tests/unit/rt_core/tree_support.hpp"

#include <Eigen/Geometry>

#include <cstdint>

namespace tactus::test
{

/// More than any query of small trees needs.
inline constexpr WalkBudget kAmple{10'000'000, 100'000'000};

[[nodiscard]] inline MeshPlacement random_placement(Random& random)
{
    const Vec3 axis = (random.in_cube(1.0) + Vec3(2, 0, 0)).normalized();
    const Mat3 rotation = Eigen::AngleAxisd(random.between(-4.0, 4.0), axis).toRotationMatrix();
    return {{rotation, random.in_cube(0.6), random.between(0.5, 2.0)}, random.in_cube(0.5)};
}

/// Adds faces of a style, a third of them coarse unless `exact_only`.
inline void fill(TreeRig& rig, Random& random, std::uint32_t count, bool exact_only)
{
    const FaceStyle& style = face_styles()[random.below(5)];
    for (std::uint32_t prim = 0; prim < count; ++prim)
    {
        ChangedFace face = random_face(random, style, prim, 3 * prim + 1);
        face.error = exact_only ? 0 : face.error;
        rig.put(face);
    }
    rig.sut->refit();
}

} // namespace tactus::test
