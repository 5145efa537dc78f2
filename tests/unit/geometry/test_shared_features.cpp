// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/closest_points.hpp"
#include "rt_core/geometry/crossing.hpp"
#include "rt_core/geometry/shared_features.hpp"
#include "tests/shared/random.hpp"
#include "tests/unit/geometry/same_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

namespace tactus::test
{

namespace
{

constexpr int kSide = 6;

/// Arrangement of two sheets of triangles above each other.
struct Sheets
{
    const char* name;
    double height; ///< Height of the bumps, in edges.
    double apart;  ///< Distance of the sheets.
    double narrow; ///< Ratio of edges across to edges along.
    double scale;
};

constexpr std::array kSheets{
    Sheets{"bumpy", 0.5, 1.2, 1.0, 1.0},
    Sheets{"shallow", 1e-3, 0.1, 1.0, 1.0},
    Sheets{"flat and parallel", 0.0, 0.3, 1.0, 1.0},
    Sheets{"needles", 0.3, 0.7, 1e-4, 1.0},
    Sheets{"all but touching", 0.5, 1e-7, 1.0, 1.0},
    Sheets{"crossing", 0.8, 0.0, 1.0, 1.0},
    Sheets{"tiny", 0.5, 1.2, 1.0, 0x1p-100},
    Sheets{"huge", 0.5, 1.2, 1.0, 0x1p100},
};

/// Bumpy sheet; its inner corners belong to six faces.
std::vector<Triangle> sheet(Random& random, const Sheets& sheets, const Vec3& at, double spread)
{
    std::vector<Vec3> corners;
    for (int i = 0; i < kSide * kSide; ++i)
    {
        const Vec3 off = spread * random.in_cube(0.3);
        const Vec3 place(i % kSide, i / kSide, sheets.height * random.between(0.0, 1.0));
        corners.push_back(
            sheets.scale *
            (at + Vec3(place.x() + off.x(), sheets.narrow * (place.y() + off.y()), place.z())));
    }
    std::vector<Triangle> faces;
    for (int y = 0; y + 1 < kSide; ++y)
    {
        for (int x = 0; x + 1 < kSide; ++x)
        {
            const auto corner = [&](int right, int up)
            { return corners[static_cast<std::size_t>((y + up) * kSide + x + right)]; };
            faces.push_back({corner(0, 0), corner(1, 0), corner(1, 1)});
            faces.push_back({corner(1, 1), corner(0, 1), corner(0, 0)});
            faces.push_back({corner(0, 0), corner(1, 1), corner(0, 0)}); // A line twice.
        }
    }
    return faces;
}

} // namespace

TEST(SharedFeatures, of_any_pairs_in_any_order_are_those_that_measuring_finds)
{
    Random random(61);
    for (const Sheets& sheets : kSheets)
    {
        int shared = 0;
        for (int round = 0; round < 12; ++round)
        {
            const double spread = round % 2 == 0 ? 1.0 : 0.0;
            const Vec3 over{random.between(0.0, 2.0), random.between(0.0, 2.0),
                            sheets.height + sheets.apart};
            const auto below = sheet(random, sheets, Vec3(0, 0, 0), spread);
            const auto above = sheet(random, sheets, over, spread);
            std::vector<std::pair<double, std::pair<const Triangle*, const Triangle*>>> pairs;
            for (const Triangle& first : above)
            {
                for (const Triangle& second : below)
                {
                    if (!meet(first, second))
                    {
                        // The order is by distance, as in a query, or random.
                        const double distance = closest_points(first, second, false).distance;
                        pairs.push_back({round % 3 == 0 ? random.between(0.0, 1.0) : distance,
                                         {&first, &second}});
                    }
                }
            }
            std::ranges::sort(pairs);
            SharedFeatures sut;
            std::set<std::pair<double, double>> points;
            for (const auto& [order, faces] : pairs)
            {
                const ClosestPoints own = closest_points(*faces.first, *faces.second, false);
                ASSERT_NO_FATAL_FAILURE(
                    expect_same(sut.closest_points(*faces.first, *faces.second), own))
                    << sheets.name;
                shared += points.insert({own.on_shape.x(), own.on_triangle.x()}).second ? 0 : 1;
            }
        }
        EXPECT_GT(shared, 500) << sheets.name; // Shows that the test is not empty.
    }
}

} // namespace tactus::test
