// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/region_grid.hpp"
#include "host_tools/encode/zone.hpp"
#include "tests/shared/distance_oracle.hpp"
#include "tests/unit/host_encode/encoded_model.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <vector>

namespace tactus
{
namespace
{

using test::Random;
using LongPoint = test::DistanceOracle::Point;

LongPoint to_long(const Vec3& v)
{
    return test::DistanceOracle::difference(v, Vec3::Zero());
}

/// True if a part of the triangle remains after clipping to the box.
bool oracle_touches(const BoxZone& box, const Triangle& triangle)
{
    std::vector<LongPoint> polygon{to_long(triangle[0]), to_long(triangle[1]),
                                   to_long(triangle[2])};
    const LongPoint low = to_long(box.low_m);
    const LongPoint high = to_long(box.high_m);
    for (std::size_t side = 0; side < 6; ++side)
    {
        const std::size_t axis = side / 2;
        const auto depth = [&](const LongPoint& p)
        { return side % 2 == 0 ? p[axis] - low[axis] : high[axis] - p[axis]; };
        std::vector<LongPoint> left;
        for (std::size_t i = 0; i < polygon.size(); ++i)
        {
            const LongPoint& here = polygon[i];
            const LongPoint& next = polygon[(i + 1) % polygon.size()];
            const long double here_depth = depth(here);
            const long double next_depth = depth(next);
            if (here_depth >= 0)
            {
                left.push_back(here);
            }
            if ((here_depth >= 0) != (next_depth >= 0))
            {
                LongPoint& crossing = left.emplace_back();
                const long double share = here_depth / (here_depth - next_depth);
                for (std::size_t k = 0; k < 3; ++k)
                {
                    crossing[k] = here[k] + share * (next[k] - here[k]);
                }
            }
        }
        polygon = left;
    }
    return !polygon.empty();
}

bool oracle_touches(const SphereZone& sphere, const Triangle& triangle)
{
    return test::DistanceOracle::distance(sphere.center_m, triangle) <=
           static_cast<long double>(sphere.radius_m);
}

/// Random triangle, including needles and tiny ones.
Triangle random_triangle(Random& random)
{
    const Vec3 center = random.in_cube(2.0);
    const double size = random.one_in(4) ? 1e-3 : 2.0;
    Triangle triangle{center + random.in_cube(size), center + random.in_cube(size),
                      center + random.in_cube(size)};
    if (random.one_in(4))
    {
        triangle[2] = triangle[1] + random.in_cube(1e-4);
    }
    return triangle;
}

/// Compares cases in which a slightly larger and a slightly smaller zone agree, so that rounding
/// has no effect.
template <typename OneZone, typename Make>
void expect_oracles_answers(std::uint64_t own, const Make& make)
{
    constexpr int kQuestions = 20'000;
    Random random(own);
    int touched = 0;
    int compared = 0;
    for (int i = 0; i < kQuestions; ++i)
    {
        const OneZone zone = make(random);
        const Triangle triangle = random_triangle(random);
        const auto nudged = [&](double margin)
        { return std::get<OneZone>(moved_and_grown(zone, Vec3::Zero(), margin)); };
        const bool expected = oracle_touches(zone, triangle);
        if (oracle_touches(nudged(1e-9), triangle) == oracle_touches(nudged(-1e-9), triangle))
        {
            EXPECT_EQ(touches(zone, triangle), expected) << "question " << i;
            ++compared;
            touched += expected ? 1 : 0;
        }
    }
    EXPECT_GT(compared, kQuestions * 99 / 100);
    EXPECT_GT(touched, kQuestions / 20);
    EXPECT_LT(touched, kQuestions * 19 / 20);
}

TEST(Zone, a_sphere_touches_what_the_oracle_says)
{
    expect_oracles_answers<SphereZone>(
        1,
        [](Random& random) {
            return SphereZone{random.in_cube(1.0), random.between(0.01, 1.5)};
        });
}

TEST(Zone, a_box_touches_what_the_oracle_says)
{
    expect_oracles_answers<BoxZone>(2,
                                    [](Random& random)
                                    {
                                        const Vec3 low = random.in_cube(1.0);
                                        return BoxZone{low, low + Vec3(random.between(0.01, 2.0),
                                                                       random.between(0.01, 2.0),
                                                                       random.between(0.01, 2.0))};
                                    });
}

TEST(Zone, its_boundary_belongs_to_it)
{
    const Triangle triangle{Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(2, 1, 0)};
    EXPECT_TRUE(touches(SphereZone{Vec3(0, 0, 0), 1.0}, triangle));
    EXPECT_TRUE(touches(BoxZone{Vec3(-1, -1, -1), Vec3(1, 1, 1)}, triangle));
    EXPECT_TRUE(touches(BoxZone{Vec3(1, 0, 0), Vec3(1, 0, 0)}, triangle)); // A point.
    EXPECT_FALSE(touches(BoxZone{Vec3(1, 0.5, 0), Vec3(1, 0.5, 0)}, triangle));
}

TEST(Zone, a_triangle_without_area_is_its_edges)
{
    const Triangle segment{Vec3(-2, 0, 0), Vec3(2, 0, 0), Vec3(1, 0, 0)};
    EXPECT_TRUE(touches(SphereZone{Vec3(0, 0.5, 0), 0.6}, segment));
    EXPECT_FALSE(touches(SphereZone{Vec3(0, 0.5, 0), 0.4}, segment));
    EXPECT_TRUE(touches(BoxZone{Vec3(-0.1, -0.1, -0.1), Vec3(0.1, 0.1, 0.1)}, segment));
    EXPECT_FALSE(touches(BoxZone{Vec3(-0.1, 0.1, -0.1), Vec3(0.1, 0.2, 0.1)}, segment));
}

TEST(Zone, moves_and_grows)
{
    const auto sphere =
        std::get<SphereZone>(moved_and_grown(SphereZone{Vec3(1, 2, 3), 0.5}, Vec3(1, 1, 1), 0.25));
    EXPECT_EQ(sphere.center_m, Vec3(0, 1, 2));
    EXPECT_EQ(sphere.radius_m, 0.75);
    const auto box = std::get<BoxZone>(
        moved_and_grown(BoxZone{Vec3(1, 2, 3), Vec3(2, 3, 4)}, Vec3(1, 1, 1), 0.25));
    EXPECT_EQ(box.low_m, Vec3(-0.25, 0.75, 1.75));
    EXPECT_EQ(box.high_m, Vec3(1.25, 2.25, 3.25));
}

bool is_marked(const RegionGrid& grid, std::size_t region)
{
    return (static_cast<unsigned>(grid.occupied[region / 8]) >> (region % 8) & 1U) != 0;
}

/// True if the box of any face reaches into the cell, by trying every face.
bool is_touched(const RegionGrid& grid, const QuantisedMesh& mesh,
                const std::array<std::uint32_t, 3>& cell)
{
    for (const auto& face : mesh.faces)
    {
        bool touches = true;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const std::int64_t start = std::int64_t{cell[axis]} * grid.cell_quanta;
            const auto [low, high] =
                std::minmax({mesh.positions[face[0]][axis], mesh.positions[face[1]][axis],
                             mesh.positions[face[2]][axis]});
            touches = touches && high >= start && low < start + grid.cell_quanta;
        }
        if (touches)
        {
            return true;
        }
    }
    return false;
}

TEST(RegionGrid, marks_exactly_the_cells_that_the_box_of_a_face_touches)
{
    for (const auto& model : sample_models())
    {
        RegionGrid sut = make_region_grid(model->fields.extent_quanta,
                                          default_cell(model->fields.extent_quanta) * 2);
        mark_occupied(sut, model->prepared.mesh);
        std::uint32_t occupied = 0;
        std::size_t region = 0;
        for (std::uint32_t z = 0; z < sut.cells[2]; ++z)
        {
            for (std::uint32_t y = 0; y < sut.cells[1]; ++y)
            {
                for (std::uint32_t x = 0; x < sut.cells[0]; ++x, ++region)
                {
                    const bool touched = is_touched(sut, model->prepared.mesh, {x, y, z});
                    EXPECT_EQ(is_marked(sut, region), touched)
                        << model->name << ", cell " << x << " " << y << " " << z;
                    occupied += touched ? 1U : 0U;
                }
            }
        }
        EXPECT_EQ(sut.occupied_count, occupied) << model->name;
    }
}

TEST(RegionGrid, the_file_says_that_every_vertex_is_in_an_occupied_region)
{
    for (const auto& model : sample_models())
    {
        const ModelHeader& header = model->store->header();
        for (std::uint32_t vertex = 0; vertex < header.counts().vertices(); ++vertex)
        {
            const Vec3f& p = model->decoded->position_m({vertex});
            const RegionId region = header.region_at(
                {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
            EXPECT_TRUE(header.is_occupied(region)) << model->name << ", vertex " << vertex;
        }
    }
}

TEST(RegionGrid, cuts_the_longest_axis_into_9_to_16_cells)
{
    for (const std::uint32_t longest : {15U, 16U, 17U, 255U, 256U, 65'535U, 16'777'215U})
    {
        const std::uint32_t cell = default_cell({3, longest, 0});
        EXPECT_TRUE(std::has_single_bit(cell)) << longest;
        const std::uint32_t cells = make_region_grid({3, longest, 0}, cell).cells[1];
        EXPECT_LE(cells, 16U) << longest;
        EXPECT_GE(cells, 9U) << longest;
    }
}

} // namespace
} // namespace tactus
