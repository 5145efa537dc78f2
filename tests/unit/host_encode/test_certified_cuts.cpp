// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Bounds of a file against its source: in every cut each point of the source is within the bound
/// of some face. A million points over all meshes, in cuts of every level.

#include "tests/unit/host_encode/certified_cuts.hpp"
#include "tests/unit/host_encode/encoded_model.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

namespace tactus::test
{

namespace
{

constexpr std::uint32_t kCuts = 8; ///< Cuts of each kind.
constexpr std::size_t kCutPoints = 11'000;

class CertifiedCuts : public testing::TestWithParam<SampleMesh>
{
};

TEST_P(CertifiedCuts, cover_the_source_and_would_not_with_a_fifth_less)
{
    const auto model = GetParam().encode();
    if (model == nullptr)
    {
        GTEST_SKIP() << "TACTUS_MESHES is not set";
    }
    expect_sound_bounds(*model, kCuts, kCutPoints, 20'261'121 + Random::seed());
}

INSTANTIATE_TEST_SUITE_P(Generated, CertifiedCuts, testing::ValuesIn(generated_meshes()),
                         mesh_name);
INSTANTIATE_TEST_SUITE_P(WellKnown, CertifiedCuts, testing::ValuesIn(known_meshes()), mesh_name);

} // namespace

} // namespace tactus::test
