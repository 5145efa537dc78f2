// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_build/placing.hpp"

#include <gtest/gtest.h>

#include <array>

/// Rotation, size and displacement by spm_build.

namespace tactus::spm_build
{

namespace
{

using Point = std::array<double, 3>;

/// Corner (0.1, 0.2, 0.3) of a model in the world, computed separately.
Point corner_of(const Pose& pose)
{
    const auto [x, y, z, w] = pose.rotation;
    const Point p{0.1 * pose.scale, 0.2 * pose.scale, 0.3 * pose.scale};
    const double r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                            {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                            {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
    Point world{};
    for (std::size_t i = 0; i < 3; ++i)
    {
        world[i] = pose.translation_m[i] + r[i][0] * p[0] + r[i][1] * p[1] + r[i][2] * p[2];
    }
    return world;
}

void expect_near(const Point& found, const Point& expected)
{
    for (std::size_t i = 0; i < 3; ++i)
    {
        EXPECT_NEAR(found[i], expected[i], 1e-12) << "axis " << i;
    }
}

constexpr std::array<double, 4> kUpright{0.0, 0.0, 0.0, 1.0};

const std::vector<Eigen::AlignedBox3d> kBoxes{
    {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(0.1, 0.2, 0.3)},
    {Eigen::Vector3d(-1.0, -1.0, -1.0), Eigen::Vector3d(1.0, 1.0, 1.0)}};

std::vector<PlacedModel> two_objects()
{
    return {{"turned", 0, {{0.0, 0.6, 0.0, 0.8}, {1.0, 2.0, 3.0}, 0.5}, {}},
            {"plain", 1, {kUpright, {10.0, 0.0, 0.0}, 1.0}, {}}};
}

TEST(BuildPlacing, turns_y_of_a_mesh_to_z)
{
    TriangleMesh mesh{{{1.0, 2.0, 3.0}, {0.0, 5.0, 0.0}}, {}};
    turn_y_up(mesh);
    EXPECT_EQ(mesh.positions[0], (Point{1.0, -3.0, 2.0}));
    EXPECT_EQ(mesh.positions[1], (Point{0.0, 0.0, 5.0}));
}

TEST(BuildPlacing, turns_a_scene_as_it_turns_each_of_its_points)
{
    auto objects = two_objects();
    const Point before = corner_of(objects[0].pose);
    std::vector<std::string> notes;
    ASSERT_FALSE(place_objects({.is_y_up = true}, kBoxes, objects, notes));
    expect_near(corner_of(objects[0].pose), {before[0], -before[2], before[1]});
    EXPECT_TRUE(notes.empty());
}

TEST(BuildPlacing, sizes_a_scene_about_its_origin)
{
    auto objects = two_objects();
    const Point before = corner_of(objects[0].pose);
    std::vector<std::string> notes;
    ASSERT_FALSE(place_objects({.scale = 0.25}, kBoxes, objects, notes));
    expect_near(corner_of(objects[0].pose), {0.25 * before[0], 0.25 * before[1], 0.25 * before[2]});
    EXPECT_EQ(objects[1].pose.scale, 0.25);
}

TEST(BuildPlacing, moves_a_scenes_middle_to_the_origin_and_says_by_how_much)
{
    std::vector<PlacedModel> objects{{"left", 1, {kUpright, {100.0, 7.0, 1.0}, 1.0}, {}},
                                     {"right", 1, {kUpright, {104.0, 7.0, 5.0}, 3.0}, {}}};
    std::vector<std::string> notes;
    ASSERT_FALSE(place_objects({.is_centered = true}, kBoxes, objects, notes));
    // The boxes extend from 99 to 107, 4 to 10 and 0 to 8.
    expect_near(objects[0].pose.translation_m, {-3.0, 0.0, -3.0});
    expect_near(objects[1].pose.translation_m, {1.0, 0.0, 1.0});
    EXPECT_EQ(notes, std::vector<std::string>{"moved by -103, -7, -4 m to the origin"});
}

TEST(BuildPlacing, does_all_three_in_their_order)
{
    std::vector<PlacedModel> objects{{"one", 0, {kUpright, {4.0, 5.0, 6.0}, 1.0}, {}}};
    std::vector<std::string> notes;
    ASSERT_FALSE(place_objects({true, 2.0, true}, kBoxes, objects, notes));
    expect_near(corner_of(objects[0].pose), {0.1, -0.3, 0.2}); // Half of its box, twice as large.
}

TEST(BuildPlacing, refuses_what_would_be_beyond_what_objects_may_be)
{
    std::vector<std::string> notes;
    auto objects = two_objects();
    const auto small = place_objects({.scale = 1e-3}, kBoxes, objects, notes);
    ASSERT_TRUE(small);
    EXPECT_EQ(small->text,
              "--scale: object 'turned' would have a scale of 0.0005; 0.001 to 1000 is "
              "allowed");
    objects = {{"far", 1, {kUpright, {1'000.0, 0.0, 0.0}, 1.0}, {}}};
    const auto far = place_objects({.scale = 100.0}, kBoxes, objects, notes);
    ASSERT_TRUE(far);
    EXPECT_EQ(far->text,
              "--scale: object 'far' would lie farther than 10000 m from the origin along an axis");
}

} // namespace

} // namespace tactus::spm_build
