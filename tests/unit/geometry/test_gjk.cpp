// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/geometry/convex_checks.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace tactus::test
{
namespace
{

GjkAnswer ask_gjk(const ConvexBody& body, const Triangle& triangle)
{
    Vec3 direction(0, 0, 0);
    return gjk_distance(body, triangle, direction);
}

/// Fault by the oracle, in Quad only if long double contradicts.
std::string broken_bound_of(const GjkAnswer& answer, const HullScene& scene, double length)
{
    const auto near = HullOracle<long double>::distance(scene.vertices, scene.triangle);
    const bool is_held = broken_bound(answer, static_cast<Quad>(near), length).empty();
    return is_held
               ? ""
               : broken_bound(answer, HullOracle<Quad>::distance(scene.vertices, scene.triangle),
                              length);
}

double off_feature(const Vec3& point, const Triangle& triangle, TriangleFeature feature)
{
    const auto at = static_cast<std::size_t>(feature);
    if (at < 3)
    {
        return (point - triangle[at]).norm();
    }
    return static_cast<double>(
        at < 6 ? DistanceOracle::to_segment(point, triangle[at - 3], triangle[(at - 2) % 3])
               : DistanceOracle::distance(point, triangle));
}

double largest_coordinate_of(const HullScene& scene)
{
    return std::max(largest_coordinate(scene.triangle), largest_coordinate(scene.vertices));
}

/// Distance from the hull, in Quad only if long double, which is insufficient for thin hulls,
/// exceeds `allowed`.
double off_hull(const Vec3& point, const HullScene& scene, double allowed)
{
    const Triangle all{point, point, point};
    const auto off = static_cast<double>(HullOracle<long double>::distance(scene.vertices, all));
    return off <= allowed ? off
                          : static_cast<double>(HullOracle<Quad>::distance(scene.vertices, all));
}

/// Checks that points are on their shapes except for rounding of their coordinates, and that `gap`
/// joins them.
void check_places(const GjkAnswer& answer, const HullScene& scene, double length)
{
    const double slack = 3e-15 * length + 2.3e-16 * largest_coordinate_of(scene);
    ASSERT_LE(off_feature(answer.on_triangle, scene.triangle, answer.feature), slack)
        << "feature " << static_cast<int>(answer.feature);
    ASSERT_LE(off_hull(answer.on_body, scene, slack), slack);
    ASSERT_LE((answer.on_triangle - answer.on_body - answer.gap).norm(), 2.0 * slack);
    ASSERT_TRUE(answer.upper == 0.0 || answer.gap.norm() <= answer.upper);
}

using GjkTest = ::testing::TestWithParam<PairClass>;

/// Figures of a whole class, besides those of each case.
struct Summary
{
    double worst_share{0.0};
    std::uint32_t iterations_max{0};
    std::uint64_t iterations{0};

    void add(const GjkAnswer& answer, double length)
    {
        worst_share = std::max(worst_share, share_of_law(answer, length));
        iterations_max = std::max(iterations_max, answer.iterations);
        iterations += answer.iterations;
    }
};

} // namespace

TEST_P(GjkTest, bounds_of_hulls_hold_the_distance_and_keep_the_law)
{
    Random random(90);
    Summary summary;
    for (int i = 0; i < convex_cases_per_class(); ++i)
    {
        const HullScene scene = hull_scene(GetParam().make(random), random);
        const Hull hull = hull_of(scene.vertices);
        const double length = local_length(hull.body(), scene.triangle);

        const GjkAnswer answer = ask_gjk(hull.body(), scene.triangle);

        ASSERT_TRUE(is_finite(answer)) << "case " << i;
        ASSERT_EQ(broken_bound_of(answer, scene, length), "")
            << "case " << i << " " << answer.lower << " " << answer.upper;
        ASSERT_LE(share_of_law(answer, length), 1.0) << "case " << i;
        if (i % 8 == 0)
        {
            check_places(answer, scene, length);
            ASSERT_FALSE(HasFatalFailure()) << "case " << i;
        }
        summary.add(answer, length);
    }
    std::printf("%s: worst share of the law %.3f, iterations %.2f, at most %u\n", GetParam().name,
                summary.worst_share,
                static_cast<double>(summary.iterations) /
                    static_cast<double>(convex_cases_per_class()),
                summary.iterations_max);
}

TEST_P(GjkTest, bounds_hold_wherever_it_begins_and_ends)
{
    Random random(91);
    for (int i = 0; i < convex_cases_per_class() / 4; ++i)
    {
        const HullScene scene = hull_scene(GetParam().make(random), random);
        const Hull hull = hull_of(scene.vertices);
        const double length = local_length(hull.body(), scene.triangle);
        const GjkAnswer usual = ask_gjk(hull.body(), scene.triangle);
        Vec3 direction = random.in_cube(1.0);
        direction *= std::exp2(random.between(-900.0, 900.0));
        const GjkAnswer other = gjk_distance(hull.body(), scene.triangle, direction);
        const double limit = random.between(0.0, 1.2) * usual.upper;
        const GjkAnswer cut = gjk_distance(hull.body(), scene.triangle, direction, limit);

        ASSERT_LE(share_of_law(other, length), 1.0) << "case " << i;
        ASSERT_LE(std::max(usual.lower, other.lower), std::min(usual.upper, other.upper));
        ASSERT_LE(cut.lower, std::min(usual.upper, other.upper)) << "case " << i;
        ASSERT_GE(cut.upper, std::max(usual.lower, other.lower)) << "case " << i;
        ASSERT_TRUE(cut.lower > limit || share_of_law(cut, length) <= 1.0) << "case " << i;
        ASSERT_NEAR(direction.norm(), 1.0, 1e-15);
    }
}

INSTANTIATE_TEST_SUITE_P(Pairs, GjkTest, ::testing::ValuesIn(pair_classes()),
                         [](const auto& kind) { return std::string(kind.param.name); });

TEST(Gjk, overlap_in_more_than_a_point_is_proven)
{
    Random random(92);
    for (int i = 0; i < 1'000; ++i)
    {
        const Box box{Vec3(1, 1, 1) + random.in_cube(0.5)};
        const std::vector<Vec3> corners = corners_of(box);
        const Hull hull = hull_of(corners);
        const Vec3 inside = 0.4 * random.in_cube(1.0);
        const Triangle triangle{inside, inside + random.in_cube(2.0), inside + random.in_cube(2.0)};

        const GjkAnswer answer = ask_gjk(hull.body(), triangle);

        ASSERT_EQ(answer.upper, 0.0) << "case " << i;
        ASSERT_EQ(answer.lower, 0.0) << "case " << i;
        ASSERT_LE(answer.gap.norm(), answer.rounding) << "case " << i;
    }
}

/// Faces so near that rounding decides on which side of each other they are.
TEST(Gjk, what_nearly_touches_is_not_proven_to_overlap)
{
    Random random(105);
    for (int i = 0; i < 5'000; ++i)
    {
        std::vector<Vec3> vertices;
        for (int j = 0; j < 4; ++j)
        {
            vertices.push_back(random.in_cube(1.0));
        }
        const Vec3 middle = (vertices[0] + vertices[1] + vertices[2]) / 3.0;
        const Vec3 way = (middle - vertices[3]) * random.between(-2e-16, 4e-16);
        Triangle triangle;
        for (std::size_t j = 0; j < 3; ++j)
        {
            triangle[j] = middle + random.between(-1.0, 1.0) * (vertices[j] - middle) + way;
        }
        const Hull hull = hull_of(vertices);

        const GjkAnswer answer = ask_gjk(hull.body(), triangle);

        ASSERT_EQ(answer.lower, 0.0) << "case " << i;
        ASSERT_LE(answer.upper, 2.0 * answer.rounding) << "case " << i;
        if (answer.upper == 0.0)
        {
            ASSERT_LT(static_cast<double>(HullOracle<Quad>::distance(vertices, triangle)), 1e-30)
                << "case " << i;
        }
    }
}

TEST(Gjk, over_a_face_is_exact_to_the_last_place)
{
    const std::vector<Vec3> corners = corners_of({Vec3(1, 1, 1)});
    const Hull hull = hull_of(corners);
    const Triangle over{Vec3(-4, -4, 3), Vec3(4, -4, 3), Vec3(0, 4, 3)};
    Vec3 direction(0, 0, 0);

    const GjkAnswer answer = gjk_distance(hull.body(), over, direction);

    EXPECT_EQ(answer.feature, TriangleFeature::interior);
    EXPECT_EQ(answer.gap, Vec3(0, 0, 2));
    EXPECT_EQ(answer.on_body.z(), 1.0);
    EXPECT_EQ(answer.on_triangle.z(), 3.0);
    EXPECT_NEAR(answer.upper, 2.0, 1e-13);
    EXPECT_NEAR(answer.lower, 2.0, 1e-13);
    EXPECT_EQ(direction, Vec3(0, 0, 1));
}

TEST(Gjk, stops_as_soon_as_it_is_beyond_the_limit)
{
    const std::vector<Vec3> corners = corners_of({Vec3(1, 0.5, 0.25)});
    const Hull hull = hull_of(corners);
    const Triangle far{Vec3(5, 3, 4), Vec3(6, 3, 4), Vec3(5, 5, 4)};
    Vec3 direction(0, 0, 0);

    const GjkAnswer answer = gjk_distance(hull.body(), far, direction, 1.0);

    EXPECT_EQ(answer.iterations, 1U);
    EXPECT_GT(answer.lower, 1.0);
}

TEST(Gjk, ends_when_the_bounds_are_as_near_as_the_tolerance_says_and_not_much_later)
{
    Random random(98);
    double widest = 0.0;
    for (int i = 0; i < 2'000; ++i)
    {
        const RoundCore round({{random.in_cube(1.0), random.in_cube(1.0)}, 1.0});
        const Vec3 outward = random.in_cube(1.0).normalized();
        const Vec3 far = outward * random.between(5.0, 30.0);
        const Triangle triangle{far + random.in_cube(2.0), far + random.in_cube(2.0),
                                far + random.in_cube(2.0)};
        const GjkAnswer answer = ask_gjk(round.body(), triangle);
        const double apart = answer.upper - answer.lower - 4.0 * answer.rounding;
        ASSERT_LT(answer.iterations, kGjkIterations) << i;
        ASSERT_LE(apart, kGjkRelativeGap * answer.upper) << i;
        widest = std::max(widest, apart / answer.upper);
    }
    EXPECT_GT(widest, 0.01 * kGjkRelativeGap);
}

TEST(Gjk, repeats_its_bits)
{
    Random random(93);
    for (int i = 0; i < 2'000; ++i)
    {
        SCOPED_TRACE(i);
        const HullScene scene =
            hull_scene(pair_classes()[random.below(kPairClasses)].make(random), random);
        const Hull hull = hull_of(scene.vertices);
        const std::vector<Vec3> elsewhere = scene.vertices;
        const Hull same = hull_of(elsewhere);

        const GjkAnswer answer = ask_gjk(hull.body(), scene.triangle);
        const GjkAnswer again = ask_gjk(same.body(), scene.triangle);

        ASSERT_EQ(answer.upper, again.upper);
        ASSERT_EQ(answer.lower, again.lower);
        ASSERT_EQ(answer.on_body, again.on_body);
        ASSERT_EQ(answer.on_triangle, again.on_triangle);
        ASSERT_EQ(answer.iterations, again.iterations);
    }
}

/// The checks above can fail.
TEST(Gjk, wrong_answers_are_found)
{
    Random random(94);
    int found_too_large = 0;
    int found_too_small = 0;
    int found_above = 0;
    constexpr int kCases = 60;
    for (int i = 0; i < kCases; ++i)
    {
        const HullScene scene = hull_scene(pair_classes()[0].make(random), random);
        const Hull hull = hull_of(scene.vertices);
        const double length = local_length(hull.body(), scene.triangle);
        const GjkAnswer answer = ask_gjk(hull.body(), scene.triangle);
        GjkAnswer too_large = answer;
        too_large.lower = answer.lower + 1e-6;
        too_large.upper = answer.upper + 1e-6;
        GjkAnswer too_small = answer;
        too_small.upper = answer.lower * (1.0 - 1e-6);
        GjkAnswer above = answer;
        above.lower = answer.upper + 1e-13 * length;

        found_too_large += broken_bound_of(too_large, scene, length).empty() ? 0 : 1;
        found_too_small += answer.lower > 0.0 && !broken_bound_of(too_small, scene, length).empty();
        found_above += broken_bound_of(above, scene, length).empty() ? 0 : 1;
    }
    EXPECT_EQ(found_too_large, kCases);
    EXPECT_GT(found_too_small, kCases / 3); // Cases with a positive distance.
    EXPECT_EQ(found_above, kCases);
}

} // namespace tactus::test
