// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/triangle.hpp"
#include "tests/unit/geometry/integer_oracle.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tactus::test
{

/// Corners on a grid of few points, so that they often coincide or are collinear or coplanar; the
/// grid's placement has no effect on the answers: scaled by a power of two, sheared by whole steps,
/// or moved so far that differences just fit.
struct Grid
{
    explicit Grid(Random& random)
        : random_(random)
        , steps_(2 + random.below(6))
        , scale_(std::ldexp(1.0, static_cast<int>(random.below(60)) - 30))
        , offset_(random.one_in(2) ? 0 : std::int64_t{1} << (20 + random.below(31)))
        , shear_(random.one_in(2) ? 0 : 1 + random.below(1000))
    {
    }

    [[nodiscard]] GridPoint point()
    {
        return {random_.below(steps_), random_.below(steps_), random_.below(steps_)};
    }
    [[nodiscard]] GridTriangle triangle() { return {point(), point(), point()}; }

    [[nodiscard]] Vec3 placed(const GridPoint& p) const
    {
        return Vec3(static_cast<double>(offset_ + p[0] + shear_ * p[1]),
                    static_cast<double>(offset_ + p[1] + shear_ * p[2]),
                    static_cast<double>(offset_ - p[2])) *
               scale_;
    }
    [[nodiscard]] Triangle placed(const GridTriangle& t) const
    {
        return {placed(t[0]), placed(t[1]), placed(t[2])};
    }

private:
    Random& random_;
    std::uint32_t steps_;
    double scale_;
    std::int64_t offset_;
    std::int64_t shear_;
};

inline constexpr int kClasses = 15;

/// Counts of both answers, which must be frequent.
struct Tally
{
    int cases{0};
    int meetings{0};

    void add(bool meets)
    {
        ++cases;
        meetings += meets ? 1 : 0;
    }
    void expect_both() const
    {
        EXPECT_GT(meetings, cases / 20);
        EXPECT_LT(meetings, cases * 19 / 20);
    }
};

} // namespace tactus::test
