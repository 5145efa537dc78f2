// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/box_triangle.hpp"
#include "rt_core/geometry/closest_points.hpp"
#include "rt_core/geometry/separations.hpp"
#include "tests/shared/kernel_trial.hpp"
#include "tests/shared/round_triangle.hpp"
#include "tests/shared/shape_scenes.hpp"
#include "tests/unit/geometry/convex_checks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <tuple>

namespace tactus::test
{
namespace
{

constexpr std::array<std::uint8_t, 3> kCorners{3, 7, 15};

/// Corners in some rows of a block; unused ones are NaN.
struct CornerBlock
{
    std::array<CornerRow, 3> rows{};
    std::uint32_t used{0};
    std::vector<std::uint8_t> places;

    CornerBlock() noexcept
    {
        for (CornerRow& row : rows)
        {
            row.fill(std::numeric_limits<float>::quiet_NaN());
        }
    }
    void put(std::uint8_t place, const Vec3& corner)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            rows[axis][place] = static_cast<float>(corner[static_cast<Eigen::Index>(axis)]);
        }
        used |= 1U << place;
        places.push_back(place);
    }
    [[nodiscard]] Vec3 corner(std::size_t i) const
    {
        return to_vec3(Vec3f{rows[0][i], rows[1][i], rows[2][i]});
    }
    [[nodiscard]] Triangle triangle(const std::array<std::uint8_t, 3>& corners) const
    {
        return {corner(corners[0]), corner(corners[1]), corner(corners[2])};
    }
};

/// Rotated hull near a block of corners.
struct SeparationsTest : ::testing::Test
{
    void make(Random& random, double away)
    {
        vertices_.clear();
        for (std::uint32_t i = 0, count = 1 + random.below(12U); i < count; ++i)
        {
            vertices_.push_back(random.in_cube(1.0));
        }
        hull_.emplace(hull_of(vertices_));
        Similarity placement;
        placement.rotation = Eigen::AngleAxisd(random.between(0, 3), random.in_cube(1).normalized())
                                 .toRotationMatrix();
        placement.translation_m = random.in_cube(100.0);
        core_ = PlacedCore(*hull_, placement);
        placed_.clear();
        for (const Vec3& vertex : vertices_)
        {
            placed_.push_back(placement.local_to_world(vertex));
        }
        block_ = CornerBlock{};
        const Vec3 middle = placement.translation_m + away * random.in_cube(1.0);
        const std::uint32_t seldom = 1 + random.below(3U);
        for (std::uint8_t place = 0; place < CornersAtCore::kCorners; ++place)
        {
            if (random.one_in(seldom) || place == CornersAtCore::kCorners / 2)
            {
                block_.put(place, middle + random.in_cube(0.5));
            }
        }
        core_.measure_corners(block_.rows, seen_);
    }
    /// Three separate corners, at `away` from the hull.
    void make_far(Random& random, const Vec3& away)
    {
        make(random, 0.0);
        block_ = CornerBlock{};
        for (const std::uint8_t place : kCorners)
        {
            block_.put(place, core_.center() + away + random.in_cube(0.5));
        }
        core_.measure_corners(block_.rows, seen_);
    }
    [[nodiscard]] double see(Separations& sut, double enough = kInfinity) const
    {
        return sut.bound_all(block_.rows, block_.used, seen_, enough);
    }
    [[nodiscard]] std::array<std::uint8_t, 3> any_triangle(Random& random) const
    {
        const auto any = [&] { return block_.places[random.below(block_.places.size())]; };
        return {any(), any(), any()};
    }

    std::vector<Vec3> vertices_; ///< Vertices in the tool frame.
    std::vector<Vec3> placed_;
    std::optional<Hull> hull_;
    PlacedCore core_;
    CornerBlock block_;
    CornersAtCore seen_;
};

TEST_F(SeparationsTest, no_bound_is_above_a_distance_whatever_directions_are_known)
{
    Random random(3'101);
    for (int trial = 0; trial < 300; ++trial)
    {
        SCOPED_TRACE("trial " + std::to_string(trial));
        make(random, random.between(0.0, 4.0));
        Separations sut(core_);
        EXPECT_LT(see(sut), 0.0);
        for (int i = 0; i < 7; ++i)
        {
            const auto corners = any_triangle(random);
            const Triangle triangle = block_.triangle(corners);
            const double slack = kTouching * local_length(core_.body(), triangle);
            const auto truth =
                static_cast<double>(HullOracle<long double>::distance(placed_, triangle));
            sut.add(random.in_cube(1.0).normalized());
            ASSERT_LE(sut.bound(corners), truth + slack);
            ASSERT_LE(see(sut), sut.bound(corners));
        }
    }
}

TEST_F(SeparationsTest, the_direction_of_a_distance_shows_that_distance)
{
    Random random(3'102);
    int apart = 0;
    for (int trial = 0; trial < 300; ++trial)
    {
        make(random, 3.0);
        Separations sut(core_);
        static_cast<void>(see(sut));
        const auto corners = any_triangle(random);
        Vec3 direction(0.0, 0.0, 0.0);
        const GjkAnswer nearest = gjk_distance(core_.body(), block_.triangle(corners), direction);
        if (nearest.lower > 0.0)
        {
            sut.add(direction);
            const double length = local_length(core_.body(), block_.triangle(corners));
            ASSERT_NEAR(sut.bound(corners), nearest.lower, 1e-13 * length);
            ++apart;
        }
    }
    EXPECT_GT(apart, 100);
}

TEST_F(SeparationsTest, a_block_that_is_far_enough_needs_no_more_directions)
{
    Random random(3'103);
    const Vec3 away(1.0, 0.0, 0.0);
    make_far(random, 10.0 * away);
    Separations sut(core_);
    static_cast<void>(see(sut));
    sut.add(away);
    const double all = see(sut);
    EXPECT_GT(all, 7.0);
    EXPECT_EQ(see(sut, 7.0), all);
    EXPECT_LT(see(sut, 20.0), 20.0);
    EXPECT_GE(sut.bound(kCorners), all);
}

TEST_F(SeparationsTest, the_direction_that_was_added_first_makes_room)
{
    Random random(3'104);
    const Vec3 away(0.0, 0.0, 1.0);
    make_far(random, 10.0 * away);
    Separations sut(core_);
    static_cast<void>(see(sut));
    for (const Vec3& direction : {away, Vec3(-away), Vec3(-away), Vec3(-away)})
    {
        sut.add(direction);
        EXPECT_GT(sut.bound(kCorners), 7.0);
    }
    sut.add(-away);
    EXPECT_LT(sut.bound(kCorners), 0.0);
    EXPECT_LT(see(sut), 0.0);
    sut.add(away); // Replaces the second one.
    EXPECT_GT(see(sut), 7.0);
}

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
