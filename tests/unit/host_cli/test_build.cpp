// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/build/build_model.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "host_tools/spm_build/placing.hpp"
#include "tests/shared/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>

/// Notes of spm_build about unlikely sizes and places, and about memory.
/// Rotation, size and displacement by spm_build.
namespace tactus::spm_build
{
namespace
{

TriangleMesh shape(const char* name)
{
    return make_shape(*parse_shape(name), 2'000).value();
}

std::vector<std::string> notes_of(double diagonal_m, double unit_m = 1.0)
{
    return size_notes(shape("sphere"), {diagonal_m, unit_m, {}}, false);
}

using Notes = std::vector<std::string>;

TEST(BuildNotes, of_a_usual_size_there_are_none)
{
    for (const double diagonal_m : {0.001, 0.2, 10.0})
    {
        EXPECT_EQ(notes_of(diagonal_m), Notes{});
    }
}

TEST(BuildNotes, of_another_size_name_every_unit_that_makes_it_usual)
{
    EXPECT_EQ(notes_of(390.0),
              Notes{"the model is 390 m across; if this size is wrong, set --unit mm (0.39 m), cm "
                    "(3.9 m) or in (9.9 m), --scale or --fit-diag"});
    EXPECT_EQ(notes_of(3'000.0), Notes{"the model is 3000 m across; if this size is wrong, set "
                                       "--unit mm (3 m), --scale or --fit-diag"});
    EXPECT_EQ(notes_of(0.0002, 0.001),
              Notes{"the model is 0.0002 m across; if this size is wrong, set --unit cm (0.002 m), "
                    "in (0.0051 m) or m (0.2 m), --scale or --fit-diag"});
    EXPECT_EQ(notes_of(1e6), Notes{"the model is 1e+06 m across; if this size is wrong, set "
                                   "--unit, --scale or --fit-diag"});
    EXPECT_EQ(size_notes(shape("sphere"), {390.0, 1.0, {}}, true), Notes{});
}

TEST(BuildNotes, are_none_of_a_terrain_that_is_as_large_as_terrains_are)
{
    TriangleMesh terrain = shape("terrain");
    ASSERT_TRUE(is_like_terrain(terrain));
    EXPECT_EQ(size_notes(terrain, {143.0, 1.0, {}}, false), Notes{});
    EXPECT_EQ(size_notes(terrain, {20'000.0, 1.0, {}}, false), Notes{});
    EXPECT_EQ(size_notes(terrain, {0.0002, 1.0, {}}, false).size(), 1U) << "a tiny one";
    for (auto& [x, y, z] : terrain.positions) // Terrain on its side, and seen from below.
    {
        std::swap(x, z);
        z = -z;
    }
    EXPECT_TRUE(is_like_terrain(terrain));
    for (auto& [x, y, z] : terrain.positions)
    {
        x *= 20.0;
    }
    EXPECT_FALSE(is_like_terrain(terrain)) << "as high as it is wide";
    for (const char* other : {"sphere", "torus", "gear", "bumpy-sphere"})
    {
        EXPECT_FALSE(is_like_terrain(shape(other))) << other;
    }
}

TEST(BuildNotes, tell_of_a_model_far_from_its_origin)
{
    const TriangleMesh mesh = shape("sphere");
    EXPECT_EQ(size_notes(mesh, {0.2, 1.0, {697.5, 7'533.0, 0.4}}, true),
              Notes{"the model lies 7533 m from its origin, 37665 times its size; --center moves "
                    "the model to the origin"});
    EXPECT_EQ(size_notes(mesh, {0.2, 1.0, {-7'533.2, 0.0, 0.0}}, true).size(), 1U);
    EXPECT_EQ(size_notes(mesh, {0.2, 1.0, {1.0, -1.0, 0.0}}, true), Notes{});
}

TEST(BuildMemory, is_the_least_of_what_machine_and_group_have_left)
{
    const test::TemporaryFolder folder;
    const auto root = folder.path();
    EXPECT_FALSE(available_mib(root)) << "nothing tells it";
    std::filesystem::create_directories(root / "proc");
    std::filesystem::create_directories(root / "sys/fs/cgroup");
    std::ofstream(root / "proc/meminfo") << "MemTotal:  8000000 kB\nMemAvailable:    4096000 kB\n";
    EXPECT_EQ(available_mib(root), 4'000U);
    std::ofstream(root / "sys/fs/cgroup/memory.max") << "max\n";
    std::ofstream(root / "sys/fs/cgroup/memory.current") << (1'000ULL << 20U) << "\n";
    EXPECT_EQ(available_mib(root), 4'000U);
    std::ofstream(root / "sys/fs/cgroup/memory.max") << (3'000ULL << 20U) << "\n";
    EXPECT_EQ(available_mib(root), 2'000U);
    std::ofstream(root / "sys/fs/cgroup/memory.max") << (500ULL << 20U) << "\n";
    EXPECT_EQ(available_mib(root), 0U) << "all is used";
}

TEST(BuildMemory, that_is_too_little_is_refused_with_the_least_that_works)
{
    const std::uint64_t needed = needed_mib(1'000'000);
    EXPECT_FALSE(check_memory("it", needed, static_cast<std::uint32_t>(needed)));
    const auto refused = check_memory("a.stl", needed, 100);
    ASSERT_TRUE(refused);
    EXPECT_EQ(refused->text,
              "a.stl needs " + std::to_string(needed) + " MiB; --memory-mib allows 100");
    const auto beyond = check_memory("a.stl", std::uint64_t{1} << 40U, std::nullopt);
    ASSERT_TRUE(beyond);
    EXPECT_NE(beyond->text.find("set --memory-mib 1099511627776 to build with swapping"),
              std::string::npos);
}

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
