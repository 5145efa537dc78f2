// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/exact_splits.hpp"
#include "tests/bench/first_contact.hpp"
#include "tests/shared/certificate_refinement.hpp"
#include "tests/shared/certified_cut.hpp"
#include "tests/shared/closed_cut.hpp"
#include "tests/shared/surface_points.hpp"
#include "tests/unit/bench/opened_model.hpp"

#include <gtest/gtest.h>

namespace tactus::bench
{
namespace
{

TEST(ExactSplits, give_the_true_distance_with_a_small_part_of_the_records)
{
    const OpenedModel model(4'000, 100);
    const test::FaceTree tree(model.model.faces);
    const ExactSplits sut = measure_exact_splits(model.decoded, model.model.faces, tree,
                                                 0.01 * model.model.diagonal_m, 300, 1);
    EXPECT_LE(sut.distance_error_max_m, 1e-15 * model.model.diagonal_m);
    EXPECT_GT(sut.splits.p50, 0.0);
    EXPECT_LT(sut.splits.max, 0.1 * model.store.header().counts().records);
}

TEST(ExactSplits, of_a_sphere_leave_no_coarse_face_in_it_and_are_all_asked_for)
{
    const OpenedModel model(4'000, 100);
    const test::CertificateRefinement refinement(model.decoded);
    test::SurfacePoints surface(model.model.faces, 1);
    const double radius_m = 0.02 * model.model.diagonal_m;
    for (int i = 0; i < 20; ++i)
    {
        const Vec3 center_m = surface.draw_by_area();
        test::ClosedCut cut(model.decoded);
        for (const RecordId split : refinement.certify_sphere(center_m, radius_m).splits)
        {
            // The dependencies are already split.
            ASSERT_EQ(cut.split_with_closure(split).size(), 1U);
        }
        const test::CertifiedCut faces = test::cut_of(model.decoded, cut.replay());
        for (std::size_t face = 0; face < faces.faces.size(); ++face)
        {
            const long double distance = test::brute_distance(center_m, faces.faces[face]);
            ASSERT_TRUE(faces.bounds_m[face] == 0.0 ||
                        distance - static_cast<long double>(faces.bounds_m[face]) >=
                            static_cast<long double>(radius_m) * (1 - 1e-12L));
        }
    }
}

struct FirstContact : testing::Test
{
    [[nodiscard]] FirstContactFigures measured(double radius_diag, std::uint32_t contacts)
    {
        return measure_first_contact(model_.store, model_.decoded, model_.model.faces,
                                     radius_diag * model_.model.diagonal_m, contacts, 1);
    }

    OpenedModel model_{20'000, 200};
};

TEST_F(FirstContact, with_the_whole_model_takes_the_whole_file)
{
    const FirstContactFigures sut = measured(2.0, 3);
    const HeaderFields& fields = model_.store.header().fields();
    EXPECT_EQ(sut.all_hashed_bytes.p50, static_cast<double>(fields.file_bytes));
    EXPECT_EQ(sut.chunks.max, model_.store.header().counts().chunks());
    EXPECT_EQ(sut.splits.p50, fields.records);
    EXPECT_EQ(sut.needed_bytes.max, sut.chunk_bytes.max);
    EXPECT_EQ(sut.missed_chunks, 0U);
    // The hashes are one a chunk, one an index page, the base mesh's and 32 bytes of root.
    const ModelCounts counts = model_.store.header().counts();
    EXPECT_EQ(sut.all_hashed_bytes.max - sut.all_bytes.max,
              16 * (counts.chunks() + counts.index_pages() + 1) + 32);
}

TEST_F(FirstContact, with_a_small_tool_takes_less_and_never_lacks_a_chunk)
{
    const FirstContactFigures small = measured(0.001, 100);
    const FirstContactFigures large = measured(0.05, 100);
    EXPECT_EQ(small.missed_chunks, 0U);
    EXPECT_EQ(large.missed_chunks, 0U);
    EXPECT_LT(small.all_bytes.p50, large.all_bytes.p50);
    EXPECT_LT(small.splits.p50, large.splits.p50);
    EXPECT_LE(small.needed_bytes.p50, small.chunk_bytes.p50);
    EXPECT_LT(large.all_bytes.max, measured(2.0, 1).all_bytes.max);
    EXPECT_LE(small.all_bytes.p50, small.all_bytes.p90);
    EXPECT_LE(small.all_bytes.p90, small.all_bytes.max);
}

} // namespace
} // namespace tactus::bench
