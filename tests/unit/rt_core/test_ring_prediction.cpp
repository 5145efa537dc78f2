// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/spm/ring_prediction.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <vector>

namespace tactus::test
{

namespace
{

constexpr std::int32_t kMost = (1 << 24) - 1;

GridPosition anywhere()
{
    GridPosition position{};
    for (std::int32_t& coordinate : position)
    {
        coordinate = *rc::gen::element(0, kMost, *rc::gen::inRange(0, kMost),
                                       *rc::gen::inRange(1'000, 1'010));
    }
    return position;
}

} // namespace

RC_GTEST_PROP(RingPrediction, a_residual_gives_the_vertex_back, ())
{
    std::vector<GridPosition> ring;
    for (int i = *rc::gen::inRange(3, 9); i > 0; --i)
    {
        ring.push_back(anywhere());
    }
    const GridPosition v = anywhere();
    const RingPrediction sut(ring);
    RC_ASSERT(sut.position_of(sut.residual_of(v)) == v);
}

TEST(RingPrediction, a_vertex_of_the_plane_s_middle_has_no_residual)
{
    // z = x / 2 + 10, the middle at (20, 20, 20).
    const std::vector<GridPosition> ring{{0, 0, 10}, {40, 0, 30}, {40, 40, 30}, {0, 40, 10}};
    const RingPrediction sut(ring);
    EXPECT_EQ(sut.residual_of({20, 20, 20}), (std::array<std::int32_t, 3>{0, 0, 0}));
    EXPECT_EQ(sut.residual_of({30, 22, 25}), (std::array<std::int32_t, 3>{10, 2, 0}));
    EXPECT_EQ(sut.residual_of({30, 22, 32})[2], 7);
}

TEST(RingPrediction, the_last_residual_counts_outward)
{
    const std::vector<GridPosition> up{{0, 0, 0}, {40, 0, 0}, {40, 40, 0}, {0, 40, 0}};
    const std::vector<GridPosition> down(up.rbegin(), up.rend());
    EXPECT_EQ(RingPrediction(up).residual_of({20, 20, 5})[2], 5);
    EXPECT_EQ(RingPrediction(down).residual_of({20, 20, 5})[2], -5);
}

TEST(RingPrediction, a_ring_without_area_predicts_its_mean)
{
    const std::vector<GridPosition> ring{{10, 10, 10}, {10, 10, 10}, {13, 10, 10}};
    const RingPrediction sut(ring);
    EXPECT_EQ(sut.position_of({0, 0, 0}), (GridPosition{11, 10, 10}));
}

TEST(StarReach, holds_the_farthest_vertex_and_the_largest_error)
{
    const std::vector<GridPosition> ring{{0, 0, 0}, {3, 4, 0}, {0, 0, kMost}};
    const ErrorCode reach = star_reach({0, 0, 0}, ring, 33);
    EXPECT_GE(static_cast<double>(error_in_quanta(reach)),
              kMost + static_cast<double>(error_in_quanta(33)));
    EXPECT_EQ(star_reach({5, 5, 5}, std::vector<GridPosition>(3, {5, 5, 5}), 0), 1);
}

} // namespace tactus::test
