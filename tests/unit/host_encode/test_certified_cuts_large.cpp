// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Bounds of a file of 1.1 M faces, and of the largest well-known mesh with ten times as many
/// points as in every run.

#include "tests/shared/certificate_refinement.hpp"
#include "tests/unit/host_encode/certified_cuts.hpp"
#include "tests/unit/host_encode/encoded_model.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

namespace tactus::test
{
namespace
{

TEST(LargeCertifiedCuts, cover_a_source_of_a_million_faces_tightly)
{
    const auto model =
        encode_source("bumpy_sphere_1_1M", make_shape(Shape::bumpy_sphere, 1'100'000).value(), 500);
    expect_sound_bounds(*model, 6, 100'000, 20'261'122 + Random::seed());
    const std::size_t faces = model->prepared.mesh.faces.size();
    EXPECT_LE(measure_certificate(model->prepared, model->simplification, faces / 6).max_ratio(),
              1.4);
    EXPECT_LE(
        measure_certificate(model->prepared, model->simplification, faces / 3 * 2).max_ratio(),
        3.5);
}

TEST(LargeCertifiedCuts, cover_every_well_known_source_at_many_levels)
{
    for (const SampleMesh& mesh : known_meshes())
    {
        const auto model = mesh.encode();
        if (model == nullptr)
        {
            GTEST_SKIP() << "TACTUS_MESHES is not set";
        }
        expect_sound_bounds(*model, 30, 30'000, 20'261'123 + Random::seed());
    }
}

} // namespace
} // namespace tactus::test
