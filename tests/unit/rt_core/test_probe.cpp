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
            for (const double beyond : {kLimit_m, std::numeric_limits<double>::infinity(),
                                        std::numeric_limits<double>::quiet_NaN()})
            {
                point[axis] = sign * beyond;
                EXPECT_TRUE(is_beyond_kernels(point, kQuantum_m)) << axis << ' ' << beyond;
            }
        }
    }
}

} // namespace
} // namespace tactus
