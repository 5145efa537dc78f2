// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/box_triangle.hpp"
#include "rt_core/geometry/crossing.hpp"
#include "rt_core/geometry/round_triangle.hpp"
#include "rt_core/geometry/segment_triangle.hpp"
#include "rt_core/geometry/triangle_triangle.hpp"
#include "tests/unit/geometry/shape_oracle.hpp"
#include "tests/unit/geometry/shape_scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>

namespace tactus::test
{

namespace
{

/// A question to a kernel, its answer, and what is right.
struct Case
{
    ClosestPoints answer;
    std::function<long double()> distance;
    std::function<Quad()> exact_distance; ///< 50 times as slow.
    std::function<double(const Vec3&)> off_shape;
    Triangle triangle;
    double magnitude; ///< Largest coordinate: points are rounded to it.
    double local_length;
};

double largest(std::initializer_list<double> values)
{
    return std::max(values);
}

double largest_coordinate_of(std::span<const Vec3> points)
{
    double most = 0.0;
    for (const Vec3& point : points)
    {
        most = std::max(most, point.cwiseAbs().maxCoeff());
    }
    return most;
}

double longest_way(std::span<const Vec3> points)
{
    double most = 0.0;
    for (const Vec3& a : points)
    {
        for (const Vec3& b : points)
        {
            most = std::max(most, (a - b).norm());
        }
    }
    return most;
}

double off_place(const Vec3& point, const Triangle& triangle, TriangleFeature feature)
{
    const auto at = static_cast<std::size_t>(feature);
    if (at < 3)
    {
        return (point - triangle[at]).norm();
    }
    return static_cast<double>(
        at < 6 ? QuadDistanceOracle::to_segment(point, triangle[at - 3], triangle[(at - 2) % 3])
               : QuadDistanceOracle::distance(point, triangle));
}

/// How far apart the wider numbers may find what meets, in local lengths, when a triangle is thin.
constexpr double kTouching = 1e-17;

/// Worst of a class, each over what is allowed.
struct Worst
{
    double law{0.0};
    double place{0.0};
    double gap{0.0};
};

bool is_finite(const ClosestPoints& answer)
{
    return answer.on_shape.allFinite() && answer.on_triangle.allFinite() &&
           answer.gap.allFinite() && std::isfinite(answer.distance) &&
           std::isfinite(answer.distance_error);
}

double share(double value, double allowed)
{
    return value == 0.0 ? 0.0 : value / allowed;
}

void check(const Case& one, Worst& worst)
{
    const ClosestPoints& answer = one.answer;
    ASSERT_TRUE(is_finite(answer));
    ASSERT_LE(answer.distance_error, 4.001e-16 * one.local_length);

    double off =
        static_cast<double>(std::abs(one.distance() - static_cast<long double>(answer.distance)));
    const double law = 4e-16 * one.local_length;
    if (off > 0.5 * law || answer.meet)
    {
        off = std::abs(
            static_cast<double>(one.exact_distance() - static_cast<Quad>(answer.distance)));
    }
    ASSERT_LE(off, answer.meet ? kTouching * one.local_length : answer.distance_error);

    const double slack = law + 2.3e-16 * one.magnitude;
    const double place = std::max(off_place(answer.on_triangle, one.triangle, answer.feature),
                                  one.off_shape(answer.on_shape));
    ASSERT_LE(place, slack) << "feature " << static_cast<int>(answer.feature);
    const double gap = largest({std::abs(answer.gap.norm() - answer.distance),
                                (answer.on_triangle - answer.on_shape - answer.gap).norm()});
    ASSERT_LE(gap, 2.0 * slack); // Both points are rounded.
    worst.law = std::max(worst.law, share(off, law));
    worst.place = std::max(worst.place, share(place, slack));
    worst.gap = std::max(worst.gap, share(gap, 2.0 * slack));
}

class ClosestPointsTest : public ::testing::TestWithParam<PairClass>
{
protected:
    /// `make` asks the kernel about a pair.
    template <typename Make>
    void run(const char* kernel, std::uint64_t seed, int cases, Make make)
    {
        Random random(seed);
        Worst worst;
        for (int i = 0; i < cases; ++i)
        {
            check(make(GetParam().make(random), random), worst);
            ASSERT_FALSE(HasFatalFailure()) << "case " << i;
        }
        std::printf("%s, %s: worst error / law %.3f, off the shapes %.3f, off the gap %.3f\n",
                    kernel, GetParam().name, worst.law, worst.place, worst.gap);
    }
};

Case of_triangles(const TrianglePair& pair)
{
    const std::array<Vec3, 6> all{pair.first[0],  pair.first[1],  pair.first[2],
                                  pair.second[0], pair.second[1], pair.second[2]};
    const ClosestPoints answer = closest_points(pair.first, pair.second);
    return {answer,
            [pair] { return ShapeOracle<long double>::distance(pair.first, pair.second); },
            [pair] { return ShapeOracle<Quad>::distance(pair.first, pair.second); },
            [pair, answer](const Vec3& point)
            { return off_place(point, pair.first, answer.shape_feature); },
            pair.second,
            largest_coordinate_of(all),
            longest_way(all)};
}

Case of_segment(const TrianglePair& pair)
{
    const Segment segment = pair.segment();
    const std::array<Vec3, 2> ends{segment.from, segment.to};
    const std::array<Vec3, 5> all{ends[0], ends[1], pair.second[0], pair.second[1], pair.second[2]};
    const ClosestPoints answer = closest_points(segment, pair.second);
    return {answer,
            [=] { return ShapeOracle<long double>::distance(ends, pair.second); },
            [=] { return ShapeOracle<Quad>::distance(ends, pair.second); },
            [=](const Vec3& point) {
                return off_place(point, {ends[0], ends[1], ends[1]}, answer.shape_feature);
            },
            pair.second,
            largest_coordinate_of(all),
            longest_way(all)};
}

Case of_box(const BoxScene& scene)
{
    std::array<Vec3, 11> all{scene.triangle[0], scene.triangle[1], scene.triangle[2]};
    for (std::size_t i = 0; i < 8; ++i)
    {
        all[3 + i] = scene.box.half.cwiseProduct(
            Vec3((i & 1U) == 0 ? 1 : -1, (i & 2U) == 0 ? 1 : -1, (i & 4U) == 0 ? 1 : -1));
    }
    return {closest_points(scene.box, scene.triangle),
            [=] { return ShapeOracle<long double>::distance(scene.box, scene.triangle); },
            [=] { return ShapeOracle<Quad>::distance(scene.box, scene.triangle); },
            [=](const Vec3& point)
            { return (point.cwiseAbs() - scene.box.half).cwiseMax(0.0).norm(); },
            scene.triangle,
            largest_coordinate_of(all),
            longest_way(all)};
}

} // namespace

TEST_P(ClosestPointsTest, of_triangles_keep_the_error_law_and_lie_on_them)
{
    run("triangle-triangle", 40, cases_per_class(),
        [](const TrianglePair& pair, Random&) { return of_triangles(pair); });
}

TEST_P(ClosestPointsTest, of_a_segment_and_a_triangle_keep_the_error_law_and_lie_on_them)
{
    run("segment-triangle", 41, cases_per_class(),
        [](const TrianglePair& pair, Random&) { return of_segment(pair); });
}

TEST_P(ClosestPointsTest, of_a_box_and_a_triangle_keep_the_error_law_and_lie_on_them)
{
    run("box-triangle", 42, cases_per_class() / 4,
        [](const TrianglePair& pair, Random& random) { return of_box(box_scene(pair, random)); });
}

INSTANTIATE_TEST_SUITE_P(Pairs, ClosestPointsTest, ::testing::ValuesIn(pair_classes()),
                         [](const auto& kind) { return std::string(kind.param.name); });

} // namespace tactus::test
