// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/sampled_distance.hpp"
#include "tests/shared/certified_cut.hpp"
#include "tests/shared/surface_points.hpp"
#include "tests/shared/test_model.hpp"
#include "tests/unit/host_simplify/small_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

// Soundness and tightness of the bounds, by brute force against sampled original points.
namespace tactus::test
{
namespace
{

/// Possible rounding of the oracle, in quanta.
constexpr double kOracleTolerance = 1e-9;

/// Cut in quanta, with scaled bounds.
CertifiedCut cut_of(const QuantisedMesh& mesh, const ForestReplay& replay, double factor = 1.0)
{
    PreparedMesh prepared;
    prepared.mesh = mesh;
    prepared.quantum_m = 1.0;
    return with_bounds_times(factor, cut_of(prepared, replay));
}

bool covers(const CertifiedCut& cut, const std::vector<Vec3>& points)
{
    return !find_violation(cut, points, kOracleTolerance).has_value();
}

/// Points of the whole source.
std::vector<Vec3> points_of(const QuantisedMesh& mesh, std::size_t count)
{
    const std::vector<Face> faces = faces_of(mesh, mesh.faces);
    return SurfacePoints(faces, 21).draw(count);
}

} // namespace

TEST(Certificate, holds_in_every_closed_cut)
{
    std::mt19937 random(21);
    for (const auto& [name, mesh] : all_small_meshes())
    {
        SCOPED_TRACE(name);
        const Simplification forest = simplified(mesh);
        const auto points = points_of(mesh, 2 * mesh.faces.size());
        for (std::size_t run = 0; run < 6; ++run)
        {
            ForestReplay cut(forest, mesh.faces.size());
            cut.split_randomly(forest.collapses.size() * run / 6, random);
            ASSERT_TRUE(covers(cut_of(mesh, cut), points)) << "cut " << run;
        }
    }
}

TEST(Certificate, is_zero_exactly_for_original_faces)
{
    for (const auto& [name, mesh] : all_small_meshes())
    {
        SCOPED_TRACE(name);
        const Simplification forest = simplified(mesh);
        std::vector<char> changed(mesh.faces.size(), 0);
        for (const Collapse& c : forest.collapses)
        {
            for (std::size_t place = 0; place < 2 + c.fan_size; ++place)
            {
                if (c.star[place] != Collapse::kNoFace)
                {
                    ASSERT_EQ(c.error[place] > 0, changed[c.star[place]] != 0);
                    changed[c.star[place]] = 1;
                }
            }
        }
        for (std::size_t i = 0; i < forest.base_faces.size(); ++i)
        {
            ASSERT_EQ(forest.base_error[i] > 0, changed[forest.base_faces[i]] != 0);
        }
    }
}

TEST(Certificate, of_a_flat_plate_is_nearly_zero)
{
    const QuantisedMesh plate = make_grid(32, 32, [](double, double) { return 0.0; });
    const Simplification forest = simplified(plate, 2);
    // Pieces stay uncut up to 2e-6 of the diagonal of 84,853 quanta.
    EXPECT_LE(std::ranges::max(forest.base_error), 0.17 * 1.001);
}

TEST(Certificate, bounds_the_base_nearly_as_tightly_as_samples_allow)
{
    const QuantisedMesh mesh = make_sphere(5'120, 0.02);
    const Simplification forest = simplified(mesh, 5120 / 6);
    CertifiedCut cut = cut_of(mesh, ForestReplay(forest, mesh.faces.size()));
    // Some sampled point is farther than the greatest bound / 1.4 from every face.
    std::ranges::fill(cut.bounds_m, std::ranges::max(cut.bounds_m) / 1.4);
    EXPECT_FALSE(covers(cut, points_of(mesh, 3 * mesh.faces.size())));
}

/// Scanned mesh with holes, only if TACTUS_MESHES names the folder that has it.
TEST(Certificate, of_a_scan_is_sound_and_tight_and_few_rounds_make_it)
{
    const auto scan = read_known(kKnownMeshes[3]);
    if (!scan)
    {
        GTEST_SKIP() << "TACTUS_MESHES is not set";
    }
    const QuantisedMesh mesh = prepare_mesh(*scan, {}).value().mesh;
    const Simplification forest = simplified(mesh, 500);
    EXPECT_LE(forest.base_faces.size(), 500U);
    EXPECT_LE(forest.rounds, 45U);
    std::mt19937 random(51);
    const auto points = points_of(mesh, 20'000);
    ForestReplay cut(forest, mesh.faces.size());
    EXPECT_TRUE(covers(cut_of(mesh, cut), points));
    EXPECT_FALSE(covers(cut_of(mesh, cut, 0.8), points));
    cut.split_randomly(200, random);
    EXPECT_EQ(manifold_fault(cut.active_corners()), "");
    EXPECT_TRUE(covers(cut_of(mesh, cut), points));
    cut.split_randomly(forest.collapses.size(), random);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    {
        ASSERT_EQ(turned(cut.faces()[f].corners), turned(mesh.faces[f]));
    }
}

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
