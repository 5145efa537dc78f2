// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/sampled_distance.hpp"
#include "tests/shared/surface_points.hpp"
#include "tests/unit/host_simplify/small_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace tactus::test
{

namespace
{

constexpr std::uint32_t kSamples = 20'000;

/// Square of 1,000 quanta in 200 faces at a height, and a handmade base with other vertices.
QuantisedMesh plate_over(std::vector<std::array<std::int32_t, 3>> base_positions)
{
    QuantisedMesh mesh = make_grid(10, 10, [](double, double) { return 0.0; });
    for (auto& position : mesh.positions)
    {
        position[2] = 300;
    }
    mesh.positions.insert(mesh.positions.end(), base_positions.begin(), base_positions.end());
    return mesh;
}

/// Least and largest corner of the plate.
std::array<std::array<std::int32_t, 3>, 2> bounds_of(const QuantisedMesh& mesh)
{
    std::array<std::array<std::int32_t, 3>, 2> bounds{mesh.positions[0], mesh.positions[0]};
    for (const auto& face : mesh.faces)
    {
        for (const std::uint32_t corner : face)
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                bounds[0][axis] = std::min(bounds[0][axis], mesh.positions[corner][axis]);
                bounds[1][axis] = std::max(bounds[1][axis], mesh.positions[corner][axis]);
            }
        }
    }
    return bounds;
}

TEST(SampledDistance, of_parallel_planes_is_their_distance)
{
    const auto [low, high] = bounds_of(plate_over({}));
    const QuantisedMesh mesh = plate_over(
        {{low[0], low[1], 0}, {high[0], low[1], 0}, {high[0], high[1], 0}, {low[0], high[1], 0}});
    const auto first = static_cast<std::uint32_t>(mesh.positions.size() - 4);
    Simplification sut;
    sut.base_corners = {{first, first + 1, first + 2}, {first, first + 2, first + 3}};
    EXPECT_DOUBLE_EQ(sampled_distance_to_base(mesh, sut, kSamples, 1), 300.0);
    EXPECT_DOUBLE_EQ(sampled_distance_to_base(mesh, sut, 1, 1), 300.0);
}

TEST(SampledDistance, comes_close_to_the_farthest_point_and_never_beyond)
{
    // The base is one corner of the plate, 300 below: the opposite corner is the farthest point.
    const auto [low, high] = bounds_of(plate_over({}));
    const QuantisedMesh mesh =
        plate_over({{low[0], low[1], 0}, {low[0] + 1, low[1], 0}, {low[0], low[1] + 1, 0}});
    const auto first = static_cast<std::uint32_t>(mesh.positions.size() - 3);
    Simplification sut;
    sut.base_corners = {{first, first + 1, first + 2}};
    const double farthest = std::hypot(high[0] - low[0], high[1] - low[1], 300.0);
    const double sampled = sampled_distance_to_base(mesh, sut, kSamples, 1);
    EXPECT_LE(sampled, farthest);
    EXPECT_GE(sampled, 0.98 * farthest);
}

TEST(SampledDistance, is_below_the_certificate_and_not_below_a_smaller_sample_by_brute_force)
{
    constexpr int kBruteSamples = 1'000;
    for (const NamedMesh& named : all_small_meshes())
    {
        const QuantisedMesh& mesh = named.mesh;
        const Simplification simplification = simplified(mesh);
        const double sut = sampled_distance_to_base(mesh, simplification, kSamples, 1);
        const float bound = *std::ranges::max_element(simplification.base_error);
        EXPECT_LE(sut, static_cast<double>(bound) + 1e-6) << named.name;
        const std::vector<Face> source = faces_of(mesh, mesh.faces);
        const std::vector<Face> base = faces_of(mesh, simplification.base_corners);
        SurfacePoints points(source, 7);
        long double largest = 0.0L;
        for (int i = 0; i < kBruteSamples; ++i)
        {
            largest = std::max(largest, brute_distance(points.draw_by_area(), base));
        }
        EXPECT_GE(sut + 1e-6, 0.95 * static_cast<double>(largest)) << named.name;
    }
}

TEST(SampledDistance, depends_on_the_seed_a_little_and_on_nothing_else)
{
    const QuantisedMesh mesh = make_sphere(5'120, 0.05);
    const Simplification simplification = simplified(mesh);
    const double one = sampled_distance_to_base(mesh, simplification, kSamples, 1);
    const double two = sampled_distance_to_base(mesh, simplification, kSamples, 2);
    EXPECT_EQ(sampled_distance_to_base(mesh, simplification, kSamples, 1), one);
    EXPECT_NE(one, two);
    EXPECT_NEAR(one, two, 0.05 * one);
}

TEST(SampledDistance, a_mesh_that_was_not_simplified_has_none)
{
    const QuantisedMesh mesh = make_torus(192);
    const Simplification simplification = simplified(mesh, 1'000);
    EXPECT_LE(sampled_distance_to_base(mesh, simplification, kSamples, 1), 1e-6);
}

} // namespace

} // namespace tactus::test
