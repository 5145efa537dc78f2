// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/choices/device_choice.hpp"
#include "tests/shared/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace tactus::test
{

namespace
{

/// Deviation of poses from orthonormal for which L and U hold (kPoseRounding).
constexpr double kOrthonormal = 2e-15;

/// Placement by `--place`, with a rotation vector in degrees.
Similarity place_turned(const Vec3& degrees)
{
    std::array<char, 128> text{};
    std::snprintf(text.data(), text.size(), "0,0,0,%.17g,%.17g,%.17g", degrees.x(), degrees.y(),
                  degrees.z());
    return hrtc::parse_placement(text.data()).value();
}

TEST(Placement, rotations_of_any_angle_are_orthonormal_and_no_mirrors)
{
    Random random(600);
    double worst = 0.0;
    for (int i = 0; i < 20'000; ++i)
    {
        const double angle_deg = std::exp2(random.between(-60.0, 8.4)); // Angles up to 338 degrees.
        const Mat3 sut = place_turned(angle_deg * random.in_cube(1.0).normalized()).rotation;
        const Mat3 off = sut.transpose() * sut - Mat3::Identity();
        worst = std::max(worst, off.norm());
        ASSERT_NEAR(sut.determinant(), 1.0, kOrthonormal) << "rotation " << i;
    }
    std::printf("worst departure %g\n", worst);
    EXPECT_LE(worst, kOrthonormal);
}

} // namespace

} // namespace tactus::test
