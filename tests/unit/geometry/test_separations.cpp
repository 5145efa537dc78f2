// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/separations.hpp"
#include "tests/unit/geometry/convex_checks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

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
class SeparationsTest : public ::testing::Test
{
protected:
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

} // namespace

} // namespace tactus::test
