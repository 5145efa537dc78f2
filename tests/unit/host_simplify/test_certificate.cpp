// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
// Soundness and tightness of the bounds, by brute force against sampled original points.
#include "tests/shared/certified_cut.hpp"
#include "tests/shared/surface_points.hpp"
#include "tests/shared/test_model.hpp"
#include "tests/unit/host_simplify/small_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

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

TEST(Certificate, is_caught_when_its_bounds_are_a_fifth_too_small)
{
    for (const QuantisedMesh& mesh : {make_sphere(1'280, 0.1), make_sphere(1'280, 0)})
    {
        const Simplification forest = simplified(mesh);
        const ForestReplay base(forest, mesh.faces.size());
        EXPECT_FALSE(covers(cut_of(mesh, base, 0.8), points_of(mesh, 4 * mesh.faces.size())));
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

} // namespace tactus::test
