// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/scene/common_places.hpp"
#include "host_tools/scene/shared_grids.hpp"

#include <gtest/gtest.h>

#include <array>
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

namespace
{

constexpr double kStep_m = 0x1p-10;

/// Mesh without faces; vertices in steps of a grid at `place_m`.
TriangleMesh vertices_at(const std::vector<Vec3>& steps, const Vec3& place_m)
{
    TriangleMesh mesh;
    for (const Vec3& at : steps)
    {
        const Vec3 at_m = place_m + kStep_m * at;
        mesh.positions.push_back({at_m.x(), at_m.y(), at_m.z()});
    }
    return mesh;
}

Vec3 steps_of(const TriangleMesh& mesh, std::size_t vertex, const Vec3& place_m)
{
    return (Vec3(mesh.positions[vertex].data()) - place_m) / kStep_m;
}

const std::array<Eigen::AlignedBox3d, 1> kEverywhere{
    Eigen::AlignedBox3d(Vec3::Constant(-1e3), Vec3::Constant(1e3))};

} // namespace

TEST(CommonPlaces, vertices_beside_the_middle_of_a_step_get_the_first_ones_place)
{
    CommonPlaces sut(kStep_m);
    const Vec3 here(0, 0, 0);
    TriangleMesh first = vertices_at({{4.4, -7.0, 0.499}, {9.2, 0.501, -3.501}}, here);
    const TriangleMesh unmoved = first;
    EXPECT_EQ(sut.settle(first, here, kEverywhere), 0.0);
    EXPECT_EQ(first.positions, unmoved.positions);

    const Vec3 there(3.0, 0.7, -20.1); // The same grid for another object.
    TriangleMesh second = vertices_at(
        {{9.1, 0.45, -3.2}, {4.45, -7.0, 0.501}, {4.45, -7.0, 0.45}, {4.6, -6.7, 0.51}}, there);
    const double moved_m = sut.settle(second, there, kEverywhere);
    EXPECT_LT((steps_of(second, 0, there) - Vec3(9, 1, -4)).norm(), 1e-9);
    EXPECT_LT((steps_of(second, 1, there) - Vec3(4, -7, 0)).norm(), 1e-9);
    EXPECT_LT((steps_of(second, 2, there) - Vec3(4.45, -7.0, 0.45)).norm(), 1e-9);
    EXPECT_LT((steps_of(second, 3, there) - Vec3(4, -7, 0)).norm(), 1e-9);
    EXPECT_NEAR(moved_m, kStep_m * Vec3(0.1, 0.55, 0.8).norm(), 1e-12);
}

TEST(CommonPlaces, vertices_that_are_apart_in_their_files_stay_so)
{
    CommonPlaces sut(kStep_m);
    const Vec3 here(0, 0, 0);
    TriangleMesh first = vertices_at({{0.499, 0, 0}}, here);
    sut.settle(first, here, kEverywhere);
    TriangleMesh second = vertices_at({{1.0, 0, 0}, {0.501, 0.51, 0}, {-0.01, 0, -0.502}}, here);
    const TriangleMesh unmoved = second;
    EXPECT_EQ(sut.settle(second, here, kEverywhere), 0.0);
    EXPECT_EQ(second.positions, unmoved.positions);
}

TEST(CommonPlaces, only_vertices_in_the_boxes_count)
{
    CommonPlaces sut(kStep_m);
    const Vec3 here(0, 0, 0);
    TriangleMesh first = vertices_at({{0.499, 0, 0}, {100.499, 0, 0}}, here);
    const std::array<Eigen::AlignedBox3d, 2> boxes{
        Eigen::AlignedBox3d(Vec3::Constant(-kStep_m), Vec3::Constant(kStep_m)),
        Eigen::AlignedBox3d(Vec3::Constant(5.0), Vec3::Constant(6.0))};
    sut.settle(first, here, boxes);
    TriangleMesh second = vertices_at({{0.501, 0, 0}, {100.501, 0, 0}}, here);
    TriangleMesh third = second;
    sut.settle(second, here, {});
    EXPECT_EQ(steps_of(second, 0, here).x(), 0.501);
    sut.settle(third, here, kEverywhere);
    EXPECT_EQ(steps_of(third, 0, here).x(), 0.0);
    EXPECT_EQ(steps_of(third, 1, here).x(), 100.501);
}
} // namespace tactus::test
