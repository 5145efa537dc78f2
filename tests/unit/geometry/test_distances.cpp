// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/box_triangle.hpp"
#include "rt_core/geometry/closest_points.hpp"
#include "tests/shared/kernel_trial.hpp"
#include "tests/shared/round_triangle.hpp"
#include "tests/shared/shape_scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <tuple>

namespace tactus::test
{
namespace
{

using Case = std::tuple<std::size_t, std::size_t>;

struct ClosestPointsTest : ::testing::TestWithParam<Case>
{
    [[nodiscard]] static const KernelTrial& kernel()
    {
        return kernel_trials()[std::get<0>(GetParam())];
    }
    [[nodiscard]] static const PairClass& kind() { return pair_classes()[std::get<1>(GetParam())]; }
    /// Cases; the oracles of boxes and round shapes are slow.
    [[nodiscard]] static int cases()
    {
        const std::string name = kernel().name;
        return name == "segment" || name == "triangle" ? cases_per_class() : cases_per_class() / 4;
    }
};

} // namespace

TEST_P(ClosestPointsTest, keep_the_error_law_and_lie_on_their_shapes)
{
    Random random(40 + std::get<0>(GetParam()));
    const TrialFigures sut = kernel().run(kind(), cases(), random);
    std::printf("%s\n", sut.summary().c_str());
    EXPECT_TRUE(sut.holds());
}

INSTANTIATE_TEST_SUITE_P(Kernels, ClosestPointsTest,
                         ::testing::Combine(::testing::Range<std::size_t>(0, kKernelTrials),
                                            ::testing::Range<std::size_t>(0, kPairClasses)),
                         [](const auto& one)
                         {
                             return std::string(kernel_trials()[std::get<0>(one.param)].name) +
                                    "_" + pair_classes()[std::get<1>(one.param)].name;
                         });

namespace
{

void expect_finite(const char* shape, const ClosestPoints& answer)
{
    SCOPED_TRACE(shape);
    ASSERT_TRUE(answer.on_shape.allFinite() && answer.on_triangle.allFinite());
    ASSERT_TRUE(answer.gap.allFinite());
    ASSERT_TRUE(std::isfinite(answer.distance) && std::isfinite(answer.distance_error));
}

/// Random numbers: zeros, any size up to `most`, and multiples of earlier ones.
struct AnyNumbers
{
    AnyNumbers(Random& random, double most) : random_(random), most_(most) {}

    [[nodiscard]] double number()
    {
        const std::uint32_t kind = random_.below(6);
        const double sign = random_.one_in(2) ? -1.0 : 1.0;
        last_ = kind == 0   ? 0.0
                : kind == 1 ? most_
                : kind == 2 ? last_
                : kind == 3 ? std::nextafter(last_, 0.0)
                : kind == 4 ? 0x1p-1074
                            : most_ * std::exp2(random_.between(-1.0, 0.0) * 2'000.0);
        return sign * last_;
    }
    [[nodiscard]] Vec3 point()
    {
        const double x = number();
        const double y = number();
        return {x, y, number()};
    }
    [[nodiscard]] Triangle triangle()
    {
        const Vec3 a = point();
        const Vec3 b = random_.one_in(4) ? a : point();
        return {a, b, random_.one_in(4) ? b : point()};
    }

private:
    Random& random_;
    double most_;
    double last_{1.0};
};

} // namespace

TEST(WideRanges, every_answer_to_finite_numbers_is_finite)
{
    Random random(80);
    AnyNumbers huge(random, 1e300);
    AnyNumbers large(random, 1e150);
    for (int i = 0; i < cases_per_class(); ++i)
    {
        const Triangle triangle = huge.triangle();
        expect_finite("triangle", closest_points(huge.triangle(), triangle));
        expect_finite("segment", closest_points(Segment{huge.point(), huge.point()}, triangle));
        expect_finite("box", closest_points(Box{huge.point().cwiseAbs()}, triangle));
        expect_finite("capsule",
                      closest_points(Capsule{{huge.point(), huge.point()}, std::abs(huge.number())},
                                     triangle));
        const Sphere sphere{large.point(), std::abs(large.number())};
        expect_finite("sphere", closest_points(sphere, large.triangle()));
        ASSERT_FALSE(::testing::Test::HasFatalFailure()) << "case " << i;
    }
}

/// Powers of two change no digit, however far from 1.
TEST(WideRanges, answers_scale_with_their_questions)
{
    Random random(81);
    for (int i = 0; i < cases_per_class(); ++i)
    {
        const TrianglePair pair = pair_classes()[random.below(kPairClasses)].make(random);
        const double factor = std::exp2(random.below(2) == 0 ? -200.0 : 200.0);
        const auto scaled = [factor](const Triangle& t) {
            return Triangle{t[0] * factor, t[1] * factor, t[2] * factor};
        };
        const Triangle first = scaled(pair.first);
        const Triangle second = scaled(pair.second);

        const ClosestPoints usual = closest_points(pair.first, pair.second);
        const ClosestPoints far = closest_points(first, second);
        const ClosestPoint point = closest_point_on_triangle(pair.first[0], pair.second);
        const ClosestPoint far_point = closest_point_on_triangle(first[0], second);

        ASSERT_EQ(far.distance, usual.distance * factor) << "case " << i;
        ASSERT_EQ(far.on_shape, usual.on_shape * factor) << "case " << i;
        ASSERT_EQ(far.feature, usual.feature) << "case " << i;
        ASSERT_EQ(far.meet, usual.meet) << "case " << i;
        ASSERT_EQ(far_point.distance_sq, point.distance_sq * factor * factor) << "case " << i;
        ASSERT_EQ(far_point.distance_error, point.distance_error * factor) << "case " << i;
        ASSERT_EQ(far_point.point, point.point * factor) << "case " << i;
    }
}
} // namespace tactus::test
