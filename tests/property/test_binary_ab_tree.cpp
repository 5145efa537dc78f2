// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Our 8-wide tree, the paper's binary one and brute force, over the same active faces with their
/// error bounds, while random records are split and merged.

#include "rt_core/query/surface_query.hpp"
#include "tests/shared/binary_ab_tree.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/owned_surface.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace tactus::test
{
namespace
{

/// One model whose forest is driven at random, and both trees over its faces.
class TwoTrees
{
public:
    TwoTrees(const TestModel& model, Random& random)
        : rig_(model, with_room_for_all())
        , random_(random)
        , diagonal_m_(model.diagonal_m)
        , binary_(loaded_faces(), rig_.model().header.quantum_m())
    {
        adopt_changes();
    }

    void split_at_random()
    {
        std::vector<RecordId> stack{{random_.below(counts().records)}};
        while (!stack.empty() && !parts().pages.is_refined(stack.back()))
        {
            const VsplitRecord* record = parts().pages.find_linked(stack.back());
            ASSERT_NE(record, nullptr);
            const RecordId missing = parts().forest.missing_dependency(*record);
            if (!missing.is_none())
            {
                stack.push_back(missing);
                continue;
            }
            ASSERT_EQ(parts().forest.split(stack.back()), VertexForest::SplitOutcome::done);
            stack.pop_back();
        }
    }

    void merge_at_random()
    {
        const RecordId record{random_.below(counts().records)};
        merged_ += parts().pages.is_refined(record) && parts().forest.try_merge(record) ? 1 : 0;
    }

    /// Hands what changed to both trees, to the binary one by comparing all faces.
    void adopt_changes()
    {
        FrameFault faults = FrameFault::none;
        WorkCounters work;
        parts().refit(work, faults);
        ASSERT_EQ(faults, FrameFault::none);
        std::map<std::uint32_t, ChangedFace> now;
        for (std::uint32_t i = 0; i < parts().forest.capacity(); ++i)
        {
            const FaceId face = parts().forest.face(PrimId{i}).id;
            if (!face.is_none())
            {
                now[face.value] = {PrimId{i}, face, 0, parts().forest.error_of(PrimId{i}),
                                   parts().forest.corners_of(PrimId{i})};
            }
        }
        for (const auto& [face, known] : active_)
        {
            if (now.count(face) == 0)
            {
                binary_.remove(FaceId{face});
            }
        }
        for (const auto& [face, changed] : now)
        {
            const auto known = active_.find(face);
            if (known == active_.end() || known->second.error != changed.error ||
                known->second.corners_m != changed.corners_m)
            {
                binary_.set(changed);
            }
        }
        active_ = std::move(now);
        binary_.refit();
    }

    void expect_same_answers(int questions)
    {
        for (int i = 0; i < questions; ++i)
        {
            const auto near = std::next(active_.begin(), random_.below(active_count()));
            const Vec3 center = to_vec3(near->second.corners_m[random_.below(3)]) +
                                random_.in_cube(0.05 * diagonal_m_);
            compare(center, random_.between(0.0, 0.03) * diagonal_m_);
        }
    }

    void expect_index_lists_agree() const
    {
        for (const auto& [face, known] : active_)
        {
            const std::uint32_t leaf = binary_.leaf_of(FaceId{face});
            EXPECT_EQ(binary_.status(leaf), BinaryAbTree::Status::active);
            std::uint32_t top = leaf;
            for (; binary_.parent(top) != BinaryAbTree::kNone; top = binary_.parent(top))
            {
                EXPECT_EQ(binary_.status(top), BinaryAbTree::Status::active);
            }
            EXPECT_EQ(top, BinaryAbTree::kRoot);
        }
    }

    [[nodiscard]] std::uint32_t active_count() const
    {
        return static_cast<std::uint32_t>(active_.size());
    }
    [[nodiscard]] int merged() const { return merged_; }

private:
    [[nodiscard]] Model& parts() { return rig_.model(); }
    [[nodiscard]] std::vector<FaceId> loaded_faces()
    {
        load_everything(rig_);
        return faces_by_path(rig_.model());
    }
    [[nodiscard]] ModelCounts counts() { return rig_.model().header.counts(); }

    void compare(const Vec3& center, double reach_m)
    {
        const float quantum_m = parts().header.quantum_m();
        OracleAnswer truth;
        for (const auto& [face, known] : active_)
        {
            truth.add(known, center, reach_m, quantum_m);
        }
        const OracleAnswer binary = binary_.query(center, reach_m);
        EXPECT_EQ(binary.lower_m, truth.lower_m);
        EXPECT_EQ(binary.upper_m, truth.upper_m);
        EXPECT_EQ(binary.exact_within, truth.exact_within);
        WalkBudget budget{1'000'000, 1'000'000};
        QueryMemory memory;
        gather_surface(parts().tree, center, reach_m, memory, budget, surface_);
        ASSERT_FALSE(surface_.truncated) << "the question's ball is too large for this test";
        const DistanceAnswer& answer = surface_.answer;
        const auto lower = std::max(0.0, static_cast<double>(truth.lower_m));
        const auto upper = static_cast<double>(truth.upper_m);
        EXPECT_LE(answer.lower_m, lower);
        EXPECT_GE(answer.upper_m, upper);
        // The kernels are charged for their errors: doubles where the answer is exact, and floats
        // with a share of the distance left unproven elsewhere.
        const double slack = 1e-10 * diagonal_m_;
        const double filter_slack = 1e-5 * diagonal_m_;
        const bool is_exact = answer.kind == AnswerKind::exact;
        const double share = static_cast<double>(kProofShare);
        EXPECT_GE(answer.lower_m, is_exact ? lower - slack : share * lower - filter_slack);
        EXPECT_LE(answer.upper_m, is_exact ? upper + slack : upper / share + filter_slack);
        if (is_exact)
        {
            EXPECT_EQ(truth.lower_m, truth.upper_m);
        }
        std::set<std::uint32_t> found;
        for (std::uint32_t i = 0; i < surface_.count; ++i)
        {
            found.insert(parts().tree.face_of(surface_.triangles[i].prim).value);
        }
        // A face at the very edge of the ball may fall on either side of it by rounding.
        OracleAnswer inner;
        OracleAnswer outer;
        for (const auto& [face, known] : active_)
        {
            inner.add(known, center, reach_m - slack, quantum_m);
            outer.add(known, center, reach_m + slack, quantum_m);
        }
        EXPECT_TRUE(std::includes(found.begin(), found.end(), inner.exact_within.begin(),
                                  inner.exact_within.end()));
        EXPECT_TRUE(std::includes(outer.exact_within.begin(), outer.exact_within.end(),
                                  found.begin(), found.end()));
    }

    FrameRig rig_;
    Random& random_;
    double diagonal_m_;
    BinaryAbTree binary_;
    std::map<std::uint32_t, ChangedFace> active_;
    OwnedSurface surface_;
    int merged_{0};
};

class BinaryTreeProperties : public testing::TestWithParam<std::size_t>
{
};

TEST_P(BinaryTreeProperties, both_trees_answer_like_brute_force_while_records_split_and_merge)
{
    const TestModel& model = small_model(GetParam());
    Random random(400 + GetParam());
    SCOPED_TRACE(model.name + " seed " + std::to_string(Random::seed()));
    TwoTrees sut(model, random);
    for (int batch = 0; batch < 24 && !HasFatalFailure(); ++batch)
    {
        // Twelve batches grow the cut, twelve shrink it.
        const std::uint32_t splits = batch < 12 ? 30 : 3;
        const std::uint32_t merges = batch < 12 ? 300 : 6'000;
        for (std::uint32_t i = 0; i < splits; ++i)
        {
            sut.split_at_random();
        }
        sut.adopt_changes();
        for (std::uint32_t i = 0; i < merges; ++i)
        {
            sut.merge_at_random();
        }
        sut.adopt_changes();
        sut.expect_same_answers(6);
    }
    sut.expect_index_lists_agree();
    EXPECT_GT(sut.merged(), 100);
}

INSTANTIATE_TEST_SUITE_P(small_models, BinaryTreeProperties, testing::Range<std::size_t>(0, 6));

/// Four faces in a row, one leaf each, so two levels above the leaves.
TEST(BinaryAbTree, a_node_is_inactive_then_active_then_deformed_and_back)
{
    std::vector<FaceId> order;
    std::vector<ChangedFace> faces;
    for (std::uint32_t i = 0; i < 4; ++i)
    {
        const auto at = static_cast<float>(i);
        order.push_back(FaceId{i});
        faces.push_back({PrimId{i},
                         FaceId{i},
                         0,
                         0,
                         {{{at, 0.0F, 0.0F}, {at + 1.0F, 0.0F, 0.0F}, {at, 1.0F, 0.0F}}}});
    }
    BinaryAbTree sut(order, 1.0F);
    using Status = BinaryAbTree::Status;
    const std::uint32_t leaf = sut.leaf_of(FaceId{2});
    EXPECT_EQ(sut.status(leaf), Status::inactive);
    EXPECT_EQ(sut.refit(), 0U);

    sut.set(faces[2]);
    EXPECT_EQ(sut.status(leaf), Status::deformed);
    EXPECT_EQ(sut.status(BinaryAbTree::kRoot), Status::deformed);
    EXPECT_EQ(sut.refit(), 3U);
    EXPECT_EQ(sut.status(leaf), Status::active);
    EXPECT_EQ(sut.status(BinaryAbTree::kRoot), Status::active);
    EXPECT_EQ(sut.status(sut.leaf_of(FaceId{3})), Status::inactive);

    sut.set(faces[2]);
    EXPECT_EQ(sut.status(sut.parent(leaf)), Status::deformed);
    EXPECT_EQ(sut.refit(), 3U);
    sut.remove(FaceId{2});
    EXPECT_EQ(sut.status(leaf), Status::deformed);
    EXPECT_EQ(sut.refit(), 3U);
    EXPECT_EQ(sut.status(leaf), Status::inactive);
    EXPECT_EQ(sut.status(BinaryAbTree::kRoot), Status::inactive);
}

} // namespace
} // namespace tactus::test
