// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/allocation_counter.hpp"
#include "rt_core/geometry/box_triangle.hpp"
#include "rt_core/query/convex_contact.hpp"
#include "tests/shared/round_triangle.hpp"
#include "tests/unit/geometry/convex_checks.hpp"
#include "tests/unit/geometry/grid.hpp"
#include "tests/unit/geometry/integer_axes.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace tactus::test
{
namespace
{

ConvexContact ask_contact(const ConvexBody& body, const Triangle& triangle)
{
    Vec3 direction(0, 0, 0);
    return contact_of(body, triangle, direction);
}

/// Number of overrulings of libccd, by case.
struct Overruled
{
    int cases{0};
    int of_apart{0};
    int of_touching{0};

    void add(const ConvexContact& contact)
    {
        ++cases;
        of_apart += contact.is_ccd_overruled && !contact.meet ? 1 : 0;
        of_touching += contact.is_ccd_overruled && contact.meet ? 1 : 0;
    }
    void print(const char* what) const
    {
        std::printf("%s: libccd overruled on %d apart and %d meeting of %d\n", what, of_apart,
                    of_touching, cases);
    }
};

std::vector<Vec3> placed(const Grid& grid, std::span<const GridPoint> points)
{
    std::vector<Vec3> result;
    for (const GridPoint& point : points)
    {
        result.push_back(grid.placed(point));
    }
    return result;
}

/// If the bodies meet no bound may deny it; if they do not, the bound must say so.
void check(const ConvexContact& contact, bool expected)
{
    ASSERT_EQ(contact.meet, expected);
    ASSERT_EQ(contact.nearest.lower == 0.0, expected);
    ASSERT_TRUE(!expected || contact.nearest.upper <= 2.0 * contact.nearest.rounding);
}

} // namespace

/// Points, segments, polygons and bodies of up to six corners, many of them touching.
TEST(ConvexContact, of_small_hulls_is_what_exact_linear_algebra_says)
{
    Random random(100);
    Tally tally;
    Overruled overruled;
    for (int i = 0; i < kClasses * convex_cases_per_class() / 2; ++i)
    {
        Grid grid(random);
        std::vector<GridPoint> corners;
        for (std::uint32_t count = 1 + random.below(6); count > 0; --count)
        {
            corners.push_back(grid.point());
        }
        const GridTriangle triangle = grid.triangle();
        const bool expected = share_a_point(corners, triangle);
        tally.add(expected);
        const std::vector<Vec3> vertices = placed(grid, corners);
        const Hull hull = hull_of(vertices);

        const ConvexContact contact = ask_contact(hull.body(), grid.placed(triangle));

        check(contact, expected);
        ASSERT_FALSE(HasFatalFailure()) << "case " << i;
        overruled.add(contact);
    }
    tally.expect_both();
    overruled.print("small hulls on grids");
}

TEST(ConvexContact, of_solid_hulls_is_what_all_separating_axes_say)
{
    Random random(101);
    Tally tally;
    Overruled overruled;
    for (int i = 0; i < kClasses * convex_cases_per_class(); ++i)
    {
        Grid grid(random);
        std::vector<GridPoint> corners;
        while (corners.size() < 4 || (random.below(8) > 0 && corners.size() < 12) ||
               IntegerAxes::is_flat(corners))
        {
            corners.push_back(grid.point());
        }
        GridTriangle triangle = grid.triangle();
        for (GridPoint& corner : triangle)
        {
            corner[0] += i % 3; // Otherwise nearly all would meet.
            corner[1] += i % 5;
        }
        const bool expected = !IntegerAxes(corners, triangle).have_plane_between();
        tally.add(expected);
        const std::vector<Vec3> vertices = placed(grid, corners);
        const Hull hull = hull_of(vertices);

        const ConvexContact contact = ask_contact(hull.body(), grid.placed(triangle));

        check(contact, expected);
        ASSERT_FALSE(HasFatalFailure()) << "case " << i;
        overruled.add(contact);
    }
    tally.expect_both();
    overruled.print("solid hulls on grids");
}

/// Exact decisions of a kernel; contacts within the rounding of the bounds count as meeting.
TEST(ConvexContact, of_boxes_is_what_their_kernel_says)
{
    Random random(102);
    Tally tally;
    Overruled overruled;
    for (int i = 0; i < kClasses * convex_cases_per_class(); ++i)
    {
        const TrianglePair pair = pair_classes()[random.below(kPairClasses)].make(random);
        const BoxScene scene = box_scene(pair, random);
        const std::vector<Vec3> corners = corners_of(scene.box);
        const Hull hull = hull_of(corners);
        const bool expected = meet(scene.box, scene.triangle);
        tally.add(expected);

        const ConvexContact contact = ask_contact(hull.body(), scene.triangle);

        const bool is_near =
            closest_points(scene.box, scene.triangle).distance <= 2.0 * contact.nearest.rounding;
        ASSERT_TRUE(contact.meet == expected || (contact.meet && is_near)) << "case " << i;
        ASSERT_TRUE(!expected || contact.nearest.lower == 0.0) << "case " << i;
        ASSERT_TRUE(expected || contact.nearest.upper > 0.0) << "case " << i;
        overruled.add(contact);
    }
    tally.expect_both();
    overruled.print("boxes");
}

/// Curved bodies: libccd decides cases that the iterations leave open, within their remainder.
TEST(ConvexContact, of_capsules_is_what_their_kernel_says)
{
    Random random(103);
    Tally tally;
    Overruled overruled;
    for (int i = 0; i < kClasses * convex_cases_per_class() / 4; ++i)
    {
        const TrianglePair pair = pair_classes()[random.below(kPairClasses)].make(random);
        const double size = (pair.first[1] - pair.first[0]).norm();
        const Capsule capsule{{pair.first[0], pair.first[1]},
                              size * std::exp2(random.between(-10.0, 1.0))};
        const RoundCore body(capsule);
        const ClosestPoints kernel = closest_points(capsule, pair.second);
        tally.add(kernel.meet);

        const ConvexContact contact = ask_contact(body.body(), pair.second);

        const double slack = 1e-9 * local_length(body.body(), pair.second);
        ASSERT_TRUE(contact.meet == kernel.meet || std::abs(kernel.distance) <= slack)
            << "case " << i << " distance " << kernel.distance;
        overruled.add(contact);
    }
    tally.expect_both();
    overruled.print("capsules");
}

TEST(ConvexContact, does_not_ask_about_what_is_beyond_the_limit)
{
    const std::vector<Vec3> corners = corners_of({Vec3(1, 1, 1)});
    const Hull hull = hull_of(corners);
    const Triangle far{Vec3(5, 5, 5), Vec3(6, 5, 5), Vec3(5, 6, 5)};
    Vec3 direction(0, 0, 0);

    const ConvexContact contact = contact_of(hull.body(), far, direction, 1.0);

    EXPECT_FALSE(contact.meet);
    EXPECT_FALSE(contact.is_ccd_overruled);
    EXPECT_GT(contact.nearest.lower, 1.0);
    EXPECT_EQ(contact.nearest.iterations, 1U);
}

namespace
{

/// Two bodies in one: the first support points are those of a small sphere, all later ones of a
/// large one. The first query finds a distance; libccd, which queries later, an overlap.
struct Liar
{
    std::uint32_t honest_answers;
    mutable std::uint32_t answers{0};

    static Vec3 support(const void* context, const Vec3& direction) noexcept TACTUS_NONBLOCKING
    {
        const auto& self = *static_cast<const Liar*>(context);
        return direction * (self.answers++ < self.honest_answers ? 1.0 : 4.0);
    }
};

} // namespace

TEST(ConvexContact, the_bound_has_the_last_word_and_says_so)
{
    const Triangle triangle{Vec3(-4, -4, 3), Vec3(4, -4, 3), Vec3(0, 4, 3)};
    const Liar large_at_last{1};
    const ConvexBody body{&Liar::support, &large_at_last, Vec3(0, 0, 0), 4.0};

    const ConvexContact contact = ask_contact(body, triangle);

    EXPECT_NEAR(contact.nearest.lower, 2.0, 1e-12);
    EXPECT_FALSE(contact.meet);
    EXPECT_TRUE(contact.is_ccd_overruled);
}

TEST(ConvexContact, leaves_the_heap_alone)
{
    if (!allocation_counter::available())
    {
        GTEST_SKIP() << "no allocation counter under this sanitizer";
    }
    Random random(104);
    std::uint64_t calls = 0;
    for (int i = 0; i < 5'000; ++i)
    {
        const HullScene scene =
            hull_scene(pair_classes()[random.below(kPairClasses)].make(random), random);
        const std::uint64_t before = allocation_counter::of_this_thread().allocations;
        allocation_counter::mark_this_thread(true);
        const Result<Hull, HullError> hull = Hull::create(scene.vertices);
        const ConvexContact contact = ask_contact(hull.value().body(), scene.triangle);
        allocation_counter::mark_this_thread(false);
        calls += allocation_counter::of_this_thread().allocations - before;
        ASSERT_TRUE(is_finite(contact.nearest));
    }
    EXPECT_EQ(calls, 0U);
}

} // namespace tactus::test
