// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/exact_splits.hpp"
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

} // namespace

} // namespace tactus::bench
