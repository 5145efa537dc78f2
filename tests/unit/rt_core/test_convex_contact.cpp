// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/allocation_counter.hpp"
#include "rt_core/geometry/box_triangle.hpp"
#include "rt_core/query/convex_contact.hpp"
#include "tests/shared/round_triangle.hpp"
#include "tests/unit/geometry/convex_checks.hpp"
#include "tests/unit/geometry/grid.hpp"
#include "tests/unit/geometry/integer_oracle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <span>

namespace tactus::test
{
namespace
{

/// Exact and complete test whether a plane separates a hull, which is not flat, of corners on a
/// grid from a triangle, by all possible normals. It tries every plane through three corners of the
/// hull, every product of two edges and the triangle's own plane; most of them belong to no side,
/// which is harmless. For coordinates up to 1,000.
struct IntegerAxes
{
    IntegerAxes(std::span<const GridPoint> hull, const GridTriangle& triangle)
        : hull_(hull), triangle_(triangle)
    {
    }

    [[nodiscard]] static bool is_flat(std::span<const GridPoint> corners)
    {
        for (const GridPoint& a : corners)
        {
            for (const GridPoint& b : corners)
            {
                for (const GridPoint& c : corners)
                {
                    const GridPoint normal = cross(way(corners[0], a), way(b, c));
                    for (const GridPoint& d : corners)
                    {
                        if (dot(normal, way(corners[0], d)) != 0)
                        {
                            return false;
                        }
                    }
                }
            }
        }
        return true;
    }

    [[nodiscard]] bool have_plane_between() const
    {
        const std::array<GridPoint, 3> edges{way(triangle_[0], triangle_[1]),
                                             way(triangle_[1], triangle_[2]),
                                             way(triangle_[2], triangle_[0])};
        if (is_between(cross(edges[0], edges[1])))
        {
            return true;
        }
        for (std::size_t i = 0; i < hull_.size(); ++i)
        {
            for (std::size_t j = 0; j < i; ++j)
            {
                const GridPoint edge = way(hull_[i], hull_[j]);
                if (is_between(cross(edge, edges[0])) || is_between(cross(edge, edges[1])) ||
                    is_between(cross(edge, edges[2])))
                {
                    return true;
                }
                for (std::size_t k = 0; k < j; ++k)
                {
                    if (is_between(cross(edge, way(hull_[i], hull_[k]))))
                    {
                        return true;
                    }
                }
            }
        }
        return false;
    }

private:
    struct Range
    {
        std::int64_t low;
        std::int64_t high;
    };

    static GridPoint way(const GridPoint& from, const GridPoint& to)
    {
        return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
    }
    static std::int64_t dot(const GridPoint& a, const GridPoint& b)
    {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }
    static GridPoint cross(const GridPoint& a, const GridPoint& b)
    {
        return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    }

    static Range extent(std::span<const GridPoint> points, const GridPoint& axis)
    {
        Range range{std::numeric_limits<std::int64_t>::max(),
                    std::numeric_limits<std::int64_t>::min()};
        for (const GridPoint& point : points)
        {
            range.low = std::min(range.low, dot(point, axis));
            range.high = std::max(range.high, dot(point, axis));
        }
        return range;
    }

    [[nodiscard]] bool is_between(const GridPoint& axis) const
    {
        const Range a = extent(hull_, axis);
        const Range b = extent(triangle_, axis);
        return a.high < b.low || b.high < a.low;
    }

    std::span<const GridPoint> hull_;
    const GridTriangle& triangle_;
};

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

/// Checks the contact of a hull of grid points with a triangle.
ConvexContact check_hull(const Grid& grid, std::span<const GridPoint> corners,
                         const GridTriangle& triangle, bool expected)
{
    const std::vector<Vec3> vertices = placed(grid, corners);
    const Hull hull = hull_of(vertices);
    const ConvexContact contact = ask_contact(hull.body(), grid.placed(triangle));
    check(contact, expected);
    return contact;
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
        overruled.add(check_hull(grid, corners, triangle, expected));
        ASSERT_FALSE(HasFatalFailure()) << "case " << i;
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
        overruled.add(check_hull(grid, corners, triangle, expected));
        ASSERT_FALSE(HasFatalFailure()) << "case " << i;
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
