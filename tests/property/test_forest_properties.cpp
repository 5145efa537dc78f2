// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// The forest's invariants on whole small models, with every chunk loaded: I1 full refinement is
/// the source, I2 undoing returns the base state, I3 every cut is manifold, I10 the finest corner.
/// The validators look at the cuts, too.

#include "rt_core/forest/validate_forest.hpp"
#include "tests/shared/loaded_forest.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace tactus::test
{
namespace
{

/// A face with its corners rotated so that the least comes first: the orientation is kept.
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

/// Every directed edge once, so each edge has at most two faces, in opposite directions.
bool is_manifold(LoadedForest& sut)
{
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const PrimId prim : sut.active())
    {
        const auto& corners = sut.forest().face(prim).corners;
        for (std::size_t i = 0; i < 3; ++i)
        {
            if (!edges.insert({corners[i].value, corners[(i + 1) % 3].value}).second)
            {
                return false;
            }
        }
    }
    return true;
}

class ForestProperties : public testing::TestWithParam<std::size_t>
{
protected:
    const TestModel& model_ = small_model(GetParam());
    std::uint64_t seed_ = seed_of(20'261'120 + GetParam());
    Random random_ = Random::seeded(seed_);

    void SetUp() override
    {
        RecordProperty("model", model_.name);
        SCOPED_TRACE("seed " + std::to_string(seed_));
    }
};

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
    EXPECT_EQ(faces.size(), model_.faces.size()) << model_.name << " seed " << seed_;
    EXPECT_TRUE(canonical_set(faces) == canonical_set(model_.faces))
        << model_.name << " seed " << seed_;
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
            ASSERT_TRUE(is_manifold(sut)) << model_.name << " seed " << seed_ << " step " << step;
            ASSERT_STREQ(text_of(find_flaw(sut.forest())).data(), "") << "step " << step;
        }
    }
    EXPECT_NE(sut.forest().state_hash(), base_hash);
    sut.merge_everything(random_);
    EXPECT_EQ(sut.forest().refined_records(), 0U) << model_.name << " seed " << seed_;
    EXPECT_EQ(sut.forest().active_faces(), base_faces);
    EXPECT_EQ(sut.forest().state_hash(), base_hash) << model_.name << " seed " << seed_;
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

TEST_P(ForestProperties, the_record_that_last_changed_a_face_is_its_finest_corner)
{
    LoadedForest sut(model_);
    for (int i = 0; i < 300; ++i)
    {
        const RecordId record = sut.random_record(random_);
        if (!sut.pages().is_refined(record))
        {
            sut.split_with_dependencies(record);
        }
    }
    for (const PrimId prim : sut.active())
    {
        const VertexForest::ActiveFace& face = sut.forest().face(prim);
        std::uint32_t deepest = 0;
        for (const VertexId corner : face.corners)
        {
            if (!sut.counts().is_base(corner))
            {
                const RecordId record = sut.counts().record_of(corner);
                deepest = std::max<std::uint32_t>(deepest, sut.pages().resident(record).depth);
            }
        }
        if (face.state.is_base())
        {
            EXPECT_EQ(deepest, 0U);
            continue;
        }
        const RecordId owner = face.state.record();
        EXPECT_EQ(sut.pages().resident(owner).depth, deepest);
        EXPECT_TRUE(std::find(face.corners.begin(), face.corners.end(),
                              sut.counts().vertex_of(owner)) != face.corners.end());
    }
}

INSTANTIATE_TEST_SUITE_P(small_models, ForestProperties, testing::Range<std::size_t>(0, 6));

} // namespace
} // namespace tactus::test
