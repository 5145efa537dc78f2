// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/similarity.hpp"
#include "rt_core/math/vec3.hpp"
#include "tests/shared/solid_cores.hpp"

#include <vector>

namespace tactus::test
{

/// Two springs between hand and tool; both about the tool's origin.
struct Springs
{
    double stiffness_n_per_m{500.0};
    double stiffness_nm_per_rad{1.0};
};

/// Where a tool comes to rest whose springs pull at it while its core may not come nearer to any
/// face than its radius.
struct Rest
{
    Similarity place;
    Vec3 force_n{0.0, 0.0, 0.0};
    Vec3 torque_nm{0.0, 0.0, 0.0};
    double deepest_m{0.0}; ///< Of what is left in the radius.
    int faces{0};          ///< That hold it.
};

/// The truth about a rigid tool at rest, by brute force: the energy of the springs is made least
/// over all places and rotations, with every pair of a face of the core and one of the source that
/// could touch measured by their corners and edges. What is inside the radius costs as a spring
/// that is a million times as stiff, in steps; Levenberg and Marquardt's method with differences
/// for derivatives. No planes, no contacts, no proxy: nothing of the product but the shapes.
///
/// It finds the rest that is next to `near`, so faces farther than 2 mm from the tool's radius
/// there are left out.
[[nodiscard]] Rest rest_of(const SolidCore& tool, const std::vector<Face>& faces,
                           const Springs& springs, const Similarity& hand, const Similarity& near);

} // namespace tactus::test
