// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// I1 full refinement is the source, I2 undoing returns the base state, I3 every cut is manifold:
/// the forest's invariants on whole small models with every chunk loaded. The validators also check
/// the cuts, and I10 the finest corner.

#include "rt_core/forest/validate_forest.hpp"
#include "rt_core/query/surface_query.hpp"
#include "tests/property/frame_checks.hpp"
#include "tests/shared/loaded_forest.hpp"
#include "tests/shared/manifold.hpp"
#include "tests/shared/owned_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace tactus::test
{
namespace
{

/// Face with its corners rotated so that the least is first, orientation kept.
Face canonical(Face face)
{
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    return face;
}

std::multiset<Face> canonical_set(const std::vector<Face>& faces)
{
    std::multiset<Face> set;
    for (const Face& face : faces)
    {
        set.insert(canonical(face));
    }
    return set;
}

std::string manifold_fault_of(LoadedForest& sut)
{
    std::vector<Corners> faces;
    for (const PrimId prim : sut.active())
    {
        const auto& [a, b, c] = sut.forest().face(prim).corners;
        faces.push_back({a.value, b.value, c.value});
    }
    return manifold_fault(faces);
}

using ForestProperties = EachModel<20'261'120>;

TEST_P(ForestProperties, full_refinement_in_any_order_is_the_source_corner_for_corner)
{
    LoadedForest sut(model_);
    sut.split_everything(random_);

    std::vector<Face> faces;
    for (const PrimId prim : sut.active())
    {
        faces.push_back(sut.forest().corners_of(prim));
        EXPECT_EQ(sut.forest().next_of(prim), kNextExact);
        EXPECT_EQ(sut.forest().error_of(prim), 0);
    }
    EXPECT_EQ(faces.size(), model_.faces.size());
    EXPECT_TRUE(canonical_set(faces) == canonical_set(model_.faces));
}

TEST_P(ForestProperties, splits_and_merges_undone_in_any_legal_order_return_the_base_state)
{
    LoadedForest sut(model_);
    const std::uint64_t base_hash = sut.forest().state_hash();
    const std::uint32_t base_faces = sut.forest().active_faces();
    for (int step = 0; step < 4'000; ++step)
    {
        const RecordId record = sut.random_record(random_);
        if (!sut.pages().is_refined(record))
        {
            sut.split_with_dependencies(record);
        }
        else
        {
            static_cast<void>(sut.forest().try_merge(record));
        }
        if (step % 1'000 == 999)
        {
            ASSERT_EQ(manifold_fault_of(sut), "") << "step " << step;
            ASSERT_STREQ(text_of(find_flaw(sut.forest())).data(), "") << "step " << step;
        }
    }
    EXPECT_NE(sut.forest().state_hash(), base_hash);
    sut.merge_everything(random_);
    EXPECT_EQ(sut.forest().refined_records(), 0U);
    EXPECT_EQ(sut.forest().active_faces(), base_faces);
    EXPECT_EQ(sut.forest().state_hash(), base_hash);
}

TEST_P(ForestProperties, the_same_cut_has_the_same_hash_however_it_was_reached)
{
    LoadedForest one(model_);
    LoadedForest other(model_);
    std::vector<RecordId> targets;
    for (int i = 0; i < 200; ++i)
    {
        targets.push_back({static_cast<std::uint32_t>(random_.below(one.counts().records))});
    }
    const auto split_all = [](LoadedForest& sut, const std::vector<RecordId>& records)
    {
        for (const RecordId record : records)
        {
            if (!sut.pages().is_refined(record))
            {
                sut.split_with_dependencies(record);
            }
        }
    };
    split_all(one, targets);
    std::reverse(targets.begin(), targets.end());
    split_all(other, targets);
    EXPECT_EQ(one.forest().state_hash(), other.forest().state_hash())
        << model_.name << " seed " << seed_;
}

INSTANTIATE_TEST_SUITE_P(small_models, ForestProperties, testing::Range<std::size_t>(0, 6));

/// I4: a certified sphere equals the full mesh.
using CertifiedSphere = EachModel<500>;

TEST_P(CertifiedSphere, holds_the_same_faces_and_distances_as_the_full_mesh)
{
    FrameRig sut(model_, {});
    OwnedSurface surface;
    int exact = 0;
    int answered = 0;
    for (int trial = 0; trial < 60; ++trial)
    {
        const Face& face = model_.faces[random_.below(model_.faces.size())];
        const Vec3 place = to_vec3(face[1]) + random_.in_cube(0.01 * model_.diagonal_m);
        sut.settle(place, {}, 400);
        const double reach = random_.between(0.008, 0.015) * model_.diagonal_m;
        const FrameOutput output = sut.step(place);
        const Vec3 center = output.tools[0].proxy_m;
        WalkBudget budget{100'000, 1'000'000};
        QueryMemory memory;
        gather_surface(sut.model().tree, center, reach, memory, budget, surface);
        const double radius = surface.answer.certified_radius_m;
        std::set<Face> found;
        for (std::uint32_t i = 0; i < surface.count; ++i)
        {
            found.insert(surface.triangles[i].corners_m);
        }
        // A face at the very edge of the sphere may be on either side by rounding.
        const double slack = 1e-12 * model_.diagonal_m;
        for (const Face& source : model_.faces)
        {
            if (brute_distance(center, source) < static_cast<long double>(radius - slack))
            {
                Face turned = source;
                bool present = false;
                for (int turn = 0; turn < 3; ++turn)
                {
                    std::rotate(turned.begin(), turned.begin() + 1, turned.end());
                    present = present || found.contains(turned);
                }
                ASSERT_TRUE(present) << "trial " << trial << ": a source face is missing";
            }
        }
        answered += surface.answer.kind == AnswerKind::separated ? 1 : 0;
        if (surface.answer.kind == AnswerKind::exact)
        {
            ++exact;
            ++answered;
            const auto truth = static_cast<double>(brute_distance(center, model_.faces));
            EXPECT_NEAR(surface.answer.upper_m, truth, 1e-14) << "trial " << trial;
        }
    }
    EXPECT_GT(exact, 3) << "of 60 trials";
    EXPECT_GT(answered, 50) << "of 60 trials";
}

INSTANTIATE_TEST_SUITE_P(small_models, CertifiedSphere, testing::Range<std::size_t>(0, 6));

} // namespace
} // namespace tactus::test
