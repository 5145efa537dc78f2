// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/scene/common_places.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace tactus::test
{

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
