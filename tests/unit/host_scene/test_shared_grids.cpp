// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/scene/shared_grids.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace tactus::test
{

namespace
{

/// Square of 10 x 10 with its least corner at (0, 0, 0) and sides of `size`.
TriangleMesh make_tile(double size)
{
    TriangleMesh mesh;
    for (unsigned i = 0; i < 121; ++i)
    {
        mesh.positions.push_back({size * (i % 11) / 10, size * (i / 11) / 10, 0.0});
    }
    for (std::uint32_t i = 0; i < 100; ++i)
    {
        const std::uint32_t a = i / 10 * 11 + i % 10;
        mesh.faces.push_back({a, a + 1, a + 12});
        mesh.faces.push_back({a, a + 12, a + 11});
    }
    return mesh;
}

Pose at(double x, double y, double z)
{
    Pose pose;
    pose.translation_m = {x, y, z};
    return pose;
}

using Groups = std::vector<std::size_t>;

} // namespace

TEST(SharedGrids, tiles_that_have_a_border_in_common_meet)
{
    SharedGrids sut(4);
    const TriangleMesh tile = make_tile(0.2);
    sut.add(0, at(1.0, 0.0, 0.0), tile);
    sut.add(1, at(7.0, 0.0, 0.0), tile);
    sut.add(2, at(1.2, 0.0, 0.0), tile);
    sut.add(3, at(1.4, 0.02, 0.0), tile); // Displaced by a square; nine corners are common.
    EXPECT_EQ(sut.first_of_each(), (Groups{0, 1, 0, 0}));
}

TEST(SharedGrids, one_common_corner_is_no_meeting)
{
    SharedGrids sut(2);
    sut.add(0, at(0, 0, 0), make_tile(0.2));
    sut.add(1, at(0.2, 0.2, 0), make_tile(0.2));
    EXPECT_EQ(sut.first_of_each(), (Groups{0, 1}));
}

TEST(SharedGrids, tiles_round_a_cross_all_meet)
{
    // Tiles of two faces each: neighbours share two corners, and all share one.
    SharedGrids sut(4);
    const TriangleMesh tile{{{0, 0, 0}, {0.2, 0, 0}, {0.2, 0.2, 0}, {0, 0.2, 0}},
                            {{0, 1, 2}, {0, 2, 3}}};
    sut.add(0, at(0.0, 0.0, 0.0), tile);
    sut.add(1, at(0.2, 0.0, 0.0), tile);
    sut.add(2, at(0.0, 0.2, 0.0), tile);
    sut.add(3, at(0.2, 0.2, 0.0), tile);
    EXPECT_EQ(sut.first_of_each(), (Groups{0, 0, 0, 0}));
}

TEST(SharedGrids, small_parts_meet_large_ones)
{
    SharedGrids sut(2);
    sut.add(0, at(0, 0, 0), make_tile(1.0));
    sut.add(1, at(0.3, 1.0, 0), make_tile(0.1 * 10));
    EXPECT_EQ(sut.first_of_each(), (Groups{0, 0}));
    SharedGrids other(2);
    other.add(0, at(0, 0, 0), make_tile(1.0));
    other.add(1, at(0.3, 1.0, 0), make_tile(0.1));
    EXPECT_EQ(other.first_of_each(), (Groups{0, 0})); // Offsets 0.3 and 0.4.
}

TEST(SharedGrids, some_common_corners_are_left_where_there_are_more_than_it_keeps)
{
    SharedGrids sut(32, 2'000);
    const TriangleMesh tile = make_tile(0.2);
    sut.add(0, at(0, 0, 0), tile);
    Groups expected{0, 0};
    for (std::size_t model = 2; model < 32; ++model)
    {
        sut.add(model, at(static_cast<double>(model), 0, 0), tile);
        expected.push_back(model);
    }
    sut.add(1, at(0, 0, 0), tile); // Place of the first one, with a tenth left.
    EXPECT_EQ(sut.first_of_each(), expected);
}

TEST(SharedGrids, objects_that_are_turned_or_scaled_apart_have_no_grid_in_common)
{
    Pose turned = at(0.2, 0.0, 0.0);
    // Rotated about the border's normal.
    turned.rotation = {std::sin(0.05), 0.0, 0.0, std::cos(0.05)};
    Pose scaled = at(0.2, 0.0, 0.0);
    scaled.scale = 0.5;
    for (const Pose& pose : {turned, scaled})
    {
        SharedGrids sut(2);
        sut.add(0, at(0, 0, 0), make_tile(0.2));
        sut.add(1, pose, make_tile(0.2 / pose.scale));
        EXPECT_EQ(sut.first_of_each(), (Groups{0, 1}));
    }
    // The same rotation with the opposite sign is equal.
    Pose opposite = turned;
    opposite.rotation = {-turned.rotation[0], 0.0, 0.0, -turned.rotation[3]};
    Pose beside = turned;
    beside.translation_m = {0.4, 0.0, 0.0};
    SharedGrids sut(2);
    sut.add(0, opposite, make_tile(0.2));
    sut.add(1, beside, make_tile(0.2));
    EXPECT_EQ(sut.first_of_each(), (Groups{0, 0}));
}

TEST(SharedGrids, the_worlds_origin_is_where_the_pose_takes_it_to_zero)
{
    Pose pose = at(0.3, -2.0, 5.0);
    pose.rotation = {0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5)}; // Quarter turn about z.
    pose.scale = 2.0;
    const auto [x, y, z] = world_origin_in(pose);
    // 2 x (-y, x, z) + (0.3, -2, 5) is the origin.
    EXPECT_NEAR(x, 1.0, 1e-15);
    EXPECT_NEAR(y, 0.15, 1e-15);
    EXPECT_NEAR(z, -2.5, 1e-15);
}

} // namespace tactus::test
