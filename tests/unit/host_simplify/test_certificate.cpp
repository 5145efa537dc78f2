// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
// Soundness and tightness of the bounds, checked by brute force against sampled original points.
#include "tests/unit/host_simplify/forest_replay.hpp"
#include "tests/unit/host_simplify/small_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace tactus::test
{

TEST(Certificate, holds_in_every_closed_cut)
{
    std::mt19937 random(21);
    for (const auto& [name, mesh] : all_small_meshes())
    {
        SCOPED_TRACE(name);
        const Simplification forest = simplified(mesh);
        const auto points = sample_surface(mesh, 1, random);
        for (std::size_t run = 0; run < 6; ++run)
        {
            ForestReplay cut(forest, mesh.faces.size());
            cut.split_randomly(forest.collapses.size() * run / 6, random);
            ASSERT_LE(worst_violation(mesh, cut.faces(), points, 1.0), kOracleTolerance)
                << "cut " << run;
        }
    }
}

TEST(Certificate, is_caught_when_its_bounds_are_a_fifth_too_small)
{
    std::mt19937 random(22);
    for (const QuantisedMesh& mesh : {make_icosphere(3, 0.1), make_icosphere(3, 0)})
    {
        const Simplification forest = simplified(mesh);
        const auto points = sample_surface(mesh, 3, random);
        const ForestReplay base(forest, mesh.faces.size());
        EXPECT_GT(worst_violation(mesh, base.faces(), points, 0.8), kOracleTolerance);
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
    std::mt19937 random(23);
    const QuantisedMesh mesh = make_icosphere(4, 0.02);
    const Simplification forest = simplified(mesh, 5120 / 6);
    const ForestReplay base(forest, mesh.faces.size());
    const float largest = std::ranges::max(forest.base_error);
    const auto points = sample_surface(mesh, 2, random);
    // Some sampled point is farther than largest / 1.4 from every face.
    auto faces = base.faces();
    for (auto& face : faces)
    {
        face.error = largest;
    }
    EXPECT_GT(worst_violation(mesh, faces, points, 1 / 1.4), kOracleTolerance);
}

} // namespace tactus::test
