// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/geometry/closest_points.hpp"

#include <gtest/gtest.h>

namespace tactus::test
{

/// Compares to the bit. Any thread.
inline void expect_same(const ClosestPoints& sut, const ClosestPoints& own)
{
    ASSERT_EQ(sut.on_shape, own.on_shape);
    ASSERT_EQ(sut.on_triangle, own.on_triangle);
    ASSERT_EQ(sut.gap, own.gap);
    ASSERT_EQ(sut.distance, own.distance);
    ASSERT_EQ(sut.distance_error, own.distance_error);
    ASSERT_EQ(sut.meet, own.meet);
    ASSERT_EQ(sut.feature, own.feature);
    ASSERT_EQ(sut.shape_feature, own.shape_feature);
}

} // namespace tactus::test
