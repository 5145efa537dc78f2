// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/build/build_model.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "host_tools/spm_build/placing.hpp"
#include "tests/shared/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

/// Notes of spm_build about unlikely sizes and places, and about memory.

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

} // namespace

} // namespace tactus::spm_build
