// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include <gtest/gtest.h>

#ifdef TACTUS_WITH_CGAL
#include "host_tools/mesh/detail/readers.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2.h>
#include <CGAL/Random.h>
#include <CGAL/point_generators_2.h>
#include <CGAL/random_polygon_2.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <vector>
#endif

/// Triangles of random simple polygons made by CGAL, checked by CGAL's exact predicates.
namespace tactus::test
{
namespace
{

TEST(CutPolygonByCgal, covers_random_simple_polygons_with_triangles_inside_them)
{
#ifndef TACTUS_WITH_CGAL
    GTEST_SKIP() << "CGAL was not installed when the tests were built";
#else
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Point2 = Kernel::Point_2;
    for (unsigned seed = 1; seed <= 200; ++seed)
    {
        CGAL::Random random(seed);
        std::vector<Point2> places;
        CGAL::random_polygon_2(4 + seed % 60, std::back_inserter(places),
                               CGAL::Random_points_in_square_2<Point2>(1.0, random));
        CGAL::Polygon_2<Kernel> polygon(places.begin(), places.end());
        ASSERT_TRUE(polygon.is_simple()) << "seed " << seed;
        if (polygon.is_clockwise_oriented())
        {
            std::reverse(places.begin(), places.end());
            polygon.reverse_orientation();
        }
        std::vector<std::array<double, 3>> corners;
        for (const Point2& p : places)
        {
            corners.push_back({p.x(), p.y(), 0.0});
        }
        const auto sut = detail::cut_polygon(corners);
        ASSERT_TRUE(sut) << "seed " << seed;
        EXPECT_EQ(sut->size(), places.size() - 2) << "seed " << seed;
        double covered = 0.0;
        for (const auto& [a, b, c] : *sut)
        {
            EXPECT_EQ(CGAL::orientation(places[a], places[b], places[c]), CGAL::LEFT_TURN)
                << "seed " << seed;
            EXPECT_EQ(polygon.bounded_side(CGAL::centroid(places[a], places[b], places[c])),
                      CGAL::ON_BOUNDED_SIDE)
                << "seed " << seed;
            covered += std::abs(CGAL::area(places[a], places[b], places[c]));
        }
        EXPECT_NEAR(covered, polygon.area(), 1e-12) << "seed " << seed;
    }
#endif
}

} // namespace
} // namespace tactus::test
