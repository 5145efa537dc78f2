// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/numbering.hpp"
#include "tests/shared/certificate_refinement.hpp"
#include "tests/unit/host_encode/certified_cuts.hpp"
#include "tests/unit/host_encode/encoded_model.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <type_traits>
#include <utility>
#include <vector>

/// Bounds of a file against its source: in every cut each point of the source is within the bound
/// of some face. A million points over all meshes, in cuts of every level.
/// Tightness of the certificate, and proof that its figures cannot be falsified.
namespace tactus::test
{
namespace
{

constexpr std::uint32_t kCuts = 8; ///< Cuts of each kind.
constexpr std::size_t kCutPoints = 11'000;

using CertifiedCuts = testing::TestWithParam<SampleMesh>;

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

/// Ratios of the worst mesh; docs/benchmarks/encoder.json has the measurements.
constexpr double kSixthRatio = 1.5;
constexpr double kTwoThirdsRatio = 3.5;
constexpr std::size_t kPoints = 200'000;

using CertificateFiguresOfMesh = testing::TestWithParam<SampleMesh>;

TEST_P(CertificateFiguresOfMesh, are_sound_and_tight)
{
    const auto model = GetParam().encode();
    if (model == nullptr)
    {
        GTEST_SKIP() << "TACTUS_MESHES is not set";
    }
    const std::size_t faces = model->prepared.mesh.faces.size();
    for (const auto& [share, limit] :
         {std::pair(6.0, kSixthRatio), std::pair(1.5, kTwoThirdsRatio)})
    {
        const auto wanted = static_cast<std::size_t>(static_cast<double>(faces) / share);
        const CertificateFigures sut =
            measure_certificate(model->prepared, model->simplification, wanted, kPoints);
        std::printf("[ figures  ] %s, %zu of %zu faces: max %.3f, mean %.3f, per face %.3f\n",
                    model->name.c_str(), sut.faces, faces, sut.max_ratio(), sut.mean_ratio(),
                    sut.face_ratio_mean);
        EXPECT_LE(sut.faces, wanted);
        EXPECT_GE(sut.faces + 2, wanted);
        EXPECT_GE(sut.max_ratio(), 1.0);
        EXPECT_LE(sut.max_ratio(), limit);
        EXPECT_LE(sut.mean_ratio(), 2.0);
    }
}

INSTANTIATE_TEST_SUITE_P(Generated, CertificateFiguresOfMesh, testing::ValuesIn(generated_meshes()),
                         mesh_name);
INSTANTIATE_TEST_SUITE_P(WellKnown, CertificateFiguresOfMesh,
                         testing::ValuesIn(smaller_known_meshes()), mesh_name);

/// Changes every bound of a simplification.
template <typename Change>
Simplification with_bounds(Simplification simplification, const Change& change)
{
    const auto change_all = [&](auto& bounds)
    {
        for (auto& bound : bounds)
        {
            bound = static_cast<std::decay_t<decltype(bound)>>(change(static_cast<double>(bound)));
        }
    };
    for (Collapse& collapse : simplification.collapses)
    {
        change_all(collapse.error);
    }
    change_all(simplification.base_error);
    return simplification;
}

TEST(CertificateFigures, one_large_bound_for_all_faces_shows_in_the_means)
{
    const auto model = generated_meshes()[1].encode();
    const std::size_t faces = model->prepared.mesh.faces.size() / 6;
    const auto figures = [&](const Simplification& simplification)
    { return measure_certificate(model->prepared, simplification, faces, kPoints); };
    const CertificateFigures honest = figures(model->simplification);
    const double largest = honest.bound_max_m / model->prepared.quantum_m;
    const CertificateFigures sut =
        figures(with_bounds(model->simplification, [=](double) { return largest; }));
    EXPECT_NEAR(sut.max_ratio(), honest.max_ratio(), 1e-6);
    EXPECT_GT(sut.mean_ratio(), 1.5 * honest.mean_ratio());
    EXPECT_GT(sut.face_ratio_mean, 1.5 * honest.face_ratio_mean);
}

TEST(CertificateFigures, bounds_a_fifth_too_small_show_in_the_largest)
{
    for (const SampleMesh& mesh : generated_meshes())
    {
        const auto model = mesh.encode();
        const CertificateFigures base = measure_certificate(
            model->prepared,
            with_bounds(model->simplification, [](double bound) { return 0.8 * bound; }), 1,
            kPoints);
        EXPECT_LT(base.max_ratio(), 1.0) << mesh.name;
    }
}

/// Sorted faces with their bounds, each rotated to its least corner.
std::vector<std::pair<Face, double>> sorted_faces(const CertifiedCut& cut)
{
    std::vector<std::pair<Face, double>> sorted;
    for (std::size_t i = 0; i < cut.faces.size(); ++i)
    {
        Face face = cut.faces[i];
        std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
        sorted.emplace_back(face, cut.bounds_m[i]);
    }
    std::sort(sorted.begin(), sorted.end());
    return sorted;
}

TEST(CertifiedCut, on_the_way_down_is_the_cut_of_the_file_with_as_many_splits)
{
    for (const SampleMesh& mesh : generated_meshes())
    {
        const auto model = mesh.encode();
        const Numbering numbering = number_model(model->prepared.mesh, model->simplification);
        const auto& collapses = model->simplification.collapses;
        ClosedCut cut(*model->decoded);
        for (const std::size_t splits : {std::size_t{0}, collapses.size() / 3, collapses.size()})
        {
            while (cut.split_count() < splits)
            {
                const Collapse& last = collapses[collapses.size() - 1 - cut.split_count()];
                cut.split_with_closure(numbering.record_of(last));
            }
            const auto stored = sorted_faces(cut_of(*model->decoded, cut.replay()));
            const auto proven =
                sorted_faces(cut_on_the_way(model->prepared, model->simplification, stored.size()));
            ASSERT_EQ(proven.size(), stored.size()) << mesh.name;
            for (std::size_t i = 0; i < stored.size(); ++i)
            {
                ASSERT_EQ(proven[i].first, stored[i].first) << mesh.name << ", face " << i;
                ASSERT_LE(proven[i].second, stored[i].second) << mesh.name << ", face " << i;
                ASSERT_EQ(proven[i].second > 0.0, stored[i].second > 0.0) << mesh.name;
            }
        }
    }
}

} // namespace
} // namespace tactus::test
