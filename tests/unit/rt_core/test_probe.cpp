// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/probe.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tactus
{
namespace
{

constexpr float kQuantum_m = 0x1p-20F;
constexpr double kLimit_m = kFarQuanta * 0x1p-20;

TEST(Probe, is_within_the_kernels_range_below_the_limit_alone)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        for (const double sign : {-1.0, 1.0})
        {
            Vec3 point(0.1, -0.2, 0.3);
            point[axis] = sign * std::nextafter(kLimit_m, 0.0);
            EXPECT_FALSE(is_beyond_kernels(point, kQuantum_m)) << axis;
            point[axis] = sign * kLimit_m;
            EXPECT_TRUE(is_beyond_kernels(point, kQuantum_m)) << axis;
        }
    }
}

TEST(Probe, is_beyond_the_kernels_with_any_coordinate_that_is_no_number)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        Vec3 point(0.1, -0.2, 0.3);
        point[axis] = std::numeric_limits<double>::quiet_NaN();
        EXPECT_TRUE(is_beyond_kernels(point, kQuantum_m)) << axis;
        point[axis] = std::numeric_limits<double>::infinity();
        EXPECT_TRUE(is_beyond_kernels(point, kQuantum_m)) << axis;
    }
}

} // namespace
} // namespace tactus
