// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/scene/broad_phase.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace tactus::test
{
namespace
{

/// Broad phase with its memory, and a copy of every sphere.
class Crowd
{
public:
    Crowd(std::uint32_t objects, std::uint32_t tools) : memory_(bytes(objects, tools))
    {
        Arena arena(memory_.bytes());
        sut = BroadPhase(arena, objects, tools);
    }

    void place(std::uint32_t object, const Sphere& sphere)
    {
        spheres[object] = sphere;
        sut.place(object, sphere);
    }
    void remove(std::uint32_t object)
    {
        spheres.erase(object);
        sut.remove(object);
    }
    [[nodiscard]] std::vector<std::uint32_t> near(std::uint32_t tool) const
    {
        const auto near = sut.near(tool);
        return {near.begin(), near.end()};
    }
    /// Distance of the nearest sphere that is not on the tool's list, in long double.
    [[nodiscard]] long double nearest_other(std::uint32_t tool, const Vec3& center) const
    {
        long double least = std::numeric_limits<long double>::infinity();
        for (const auto& [object, sphere] : spheres)
        {
            if (!std::ranges::binary_search(sut.near(tool), object))
            {
                least = std::min(least, gap(center, sphere));
            }
        }
        return least;
    }
    [[nodiscard]] static long double gap(const Vec3& center, const Sphere& sphere)
    {
        long double square = 0.0L;
        for (int axis = 0; axis < 3; ++axis)
        {
            const long double way = static_cast<long double>(center[axis]) -
                                    static_cast<long double>(sphere.center[axis]);
            square += way * way;
        }
        return std::sqrt(square) - static_cast<long double>(sphere.radius);
    }

    BroadPhase sut;
    std::map<std::uint32_t, Sphere> spheres;

private:
    static std::size_t bytes(std::uint32_t objects, std::uint32_t tools)
    {
        Arena arena = Arena::measuring();
        const BroadPhase measured(arena, objects, tools);
        return arena.used();
    }

    ArenaMemory memory_;
};

/// Moves, adds and removes objects and tools in a world of this size, and checks the clearances.
void expect_proofs(std::uint64_t seed, std::uint32_t objects, std::uint32_t tools, double world_m,
                   double radius_m)
{
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random = Random::seeded(seed);
    Crowd crowd(objects, tools);
    const auto any_sphere = [&] {
        return Sphere{random.in_cube(world_m), radius_m * random.between(0.0, 2.0)};
    };
    for (std::uint32_t i = 0; i < objects; i += 1 + random.below(2))
    {
        crowd.place(i, any_sphere());
    }
    std::vector<Vec3> centers;
    std::vector<Vec3> ways;
    for (std::uint32_t i = 0; i < tools; ++i)
    {
        centers.push_back(random.in_cube(world_m));
        ways.push_back(random.in_cube(0.003 * world_m));
    }
    const double near_m = 0.1 * world_m;
    std::vector<std::uint32_t> unproven(tools);
    for (int frame = 0; frame < 300; ++frame)
    {
        SCOPED_TRACE("frame " + std::to_string(frame));
        for (int change = 0; change < 3; ++change)
        {
            const std::uint32_t object = random.below(objects);
            const bool is_resident = crowd.spheres.contains(object);
            if (is_resident && random.below(4) == 0)
            {
                crowd.remove(object);
            }
            else
            {
                crowd.place(object, is_resident && random.below(3) > 0
                                        ? Sphere{crowd.spheres[object].center +
                                                     random.in_cube(0.01 * world_m),
                                                 crowd.spheres[object].radius}
                                        : any_sphere());
            }
        }
        for (std::uint32_t i = 0; i < tools; ++i)
        {
            if (random.below(10) == 0)
            {
                ways[i] = random.below(3) == 0 ? Vec3(0, 0, 0) : random.in_cube(0.003 * world_m);
            }
            centers[i] =
                random.below(60) == 0 ? random.in_cube(world_m) : Vec3(centers[i] + ways[i]);
            crowd.sut.move_tool(i, centers[i], near_m);
        }
        crowd.sut.walk();
        ASSERT_LE(crowd.sut.walks(), kBroadWalks);
        ASSERT_EQ(crowd.sut.objects(), crowd.spheres.size());
        for (std::uint32_t i = 0; i < tools; ++i)
        {
            const auto near = crowd.near(i);
            ASSERT_TRUE(std::ranges::is_sorted(near)) << "tool " << i;
            ASSERT_EQ(std::set(near.begin(), near.end()).size(), near.size()) << "tool " << i;
            ASSERT_LE(near.size(), kMaxNear) << "tool " << i;
            for (const std::uint32_t object : near)
            {
                ASSERT_TRUE(crowd.spheres.contains(object)) << "tool " << i;
                ASSERT_LE(crowd.sut.gap_m(i, object), Crowd::gap(centers[i], crowd.spheres[object]))
                    << "tool " << i;
                ASSERT_GE(crowd.sut.gap_m(i, object) + 1e-12 * world_m,
                          Crowd::gap(centers[i], crowd.spheres[object]))
                    << "tool " << i;
            }
            ASSERT_LE(crowd.sut.clear_m(i), crowd.nearest_other(i, centers[i])) << "tool " << i;
            // A requested clearance is proven, or waits no longer than its turn.
            const bool is_full = near.size() == kMaxNear;
            unproven[i] = crowd.sut.clear_m(i) < near_m && !is_full ? unproven[i] + 1 : 0;
            ASSERT_LE(unproven[i], (tools + kBroadWalks - 1) / kBroadWalks + 8) << "tool " << i;
        }
    }
}

TEST(BroadPhase, names_what_is_near_and_proves_that_nothing_else_is)
{
    for (std::uint64_t i = 0; i < 12; ++i)
    {
        expect_proofs(seed_of(700 + i), 200, 1 + static_cast<std::uint32_t>(i) % kMaxTools, 1.0,
                      0.02);
    }
    expect_proofs(seed_of(720), 1, 1, 1.0, 0.5);
    expect_proofs(seed_of(721), 65, 2, 2e4, 1.0);          // Greatest number of places.
    expect_proofs(seed_of(722), 300, kMaxTools, 1.0, 0.5); // Around every tool.
    expect_proofs(seed_of(723), kMaxObjects, 3, 1.0, 0.001);
}

TEST(BroadPhase, of_nothing_is_clear_for_ever)
{
    Crowd crowd(8, 2);
    crowd.sut.move_tool(0, Vec3(0, 0, 0), 1.0);
    EXPECT_LT(crowd.sut.clear_m(0), 0.0);
    crowd.sut.walk();
    EXPECT_TRUE(crowd.near(0).empty());
    EXPECT_EQ(crowd.sut.clear_m(0), kInfinity);
    for (int i = 0; i < 100; ++i)
    {
        crowd.sut.move_tool(0, Vec3(i, 0, 0), 1.0);
        crowd.sut.walk();
        ASSERT_EQ(crowd.sut.walks(), 0U);
    }
}

TEST(BroadPhase, at_rest_walks_once_and_lists_the_nearest_however_far)
{
    Crowd crowd(100, 1);
    for (std::uint32_t i = 0; i < 100; ++i)
    {
        crowd.place(i, {Vec3(10.0 + i, 0.0, 0.0), 0.5});
    }
    crowd.sut.move_tool(0, Vec3(0, 0, 0), 1.0);
    crowd.sut.walk();
    EXPECT_EQ(crowd.near(0), std::vector<std::uint32_t>{0});
    EXPECT_NEAR(crowd.sut.clear_m(0), 10.5, 1e-12);
    for (int i = 0; i < 100; ++i)
    {
        crowd.sut.move_tool(0, Vec3(0, 0, 0), 1.0);
        crowd.sut.walk();
        ASSERT_EQ(crowd.sut.walks(), 0U);
        ASSERT_EQ(crowd.sut.looked_at(), 0U);
    }
    crowd.remove(0); // A new search is needed for the nearest one.
    crowd.sut.walk();
    EXPECT_EQ(crowd.near(0), std::vector<std::uint32_t>{1});
}

TEST(BroadPhase, leaves_out_groups_that_are_far)
{
    Crowd crowd(1'024, 1);
    for (std::uint32_t i = 0; i < 1'024; ++i)
    {
        crowd.place(i, {Vec3(0.1 * i, 0.0, 0.0), 0.01});
    }
    crowd.sut.move_tool(0, Vec3(0, 0, 0), 0.5);
    crowd.sut.walk();
    EXPECT_EQ(crowd.sut.looked_at(), 64U);
}

TEST(BroadPhase, with_more_round_a_tool_than_fits_lists_the_nearest_and_is_clear_of_the_rest)
{
    for (const std::uint32_t round : {kMaxNear - 1, kMaxNear, kMaxNear + 1, 3 * kMaxNear})
    {
        Crowd crowd(3 * kMaxNear, 1);
        for (std::uint32_t i = 0; i < round; ++i)
        {
            crowd.place((i * 7) % round, {Vec3(0.01 * ((i * 7) % round), 0.0, 0.0), 0.001});
        }
        crowd.sut.move_tool(0, Vec3(0, 0, 0), 10.0);
        crowd.sut.walk();
        const std::uint32_t listed = std::min(round, kMaxNear);
        ASSERT_EQ(crowd.near(0).size(), listed);
        EXPECT_EQ(crowd.near(0).back(), listed - 1);
        if (round <= kMaxNear)
        {
            EXPECT_EQ(crowd.sut.clear_m(0), kInfinity);
            continue;
        }
        EXPECT_NEAR(crowd.sut.clear_m(0), 0.01 * kMaxNear - 0.001, 1e-12);
        // Another walk would find the same, so it does not happen in every frame.
        std::uint32_t walks = 0;
        for (int i = 0; i < 80; ++i)
        {
            crowd.sut.move_tool(0, Vec3(0, 0, 0), 10.0);
            crowd.sut.walk();
            walks += crowd.sut.walks();
        }
        EXPECT_LE(walks, 10U);
        EXPECT_GE(walks, 8U);
    }
}

} // namespace
} // namespace tactus::test
