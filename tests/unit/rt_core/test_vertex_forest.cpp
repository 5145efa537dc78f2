// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// I2 undoing returns the state, I3 every cut is manifold, I6 the tree follows: splits and merges
/// of a handmade model.

#include "rt_core/forest/vertex_forest.hpp"
#include "tests/shared/validate_tree.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <map>
#include <optional>
#include <set>

namespace tactus::test
{

namespace
{

/// Tetrahedron 0 1 2 3 and three handmade records:
///
///     record 0 (vertex 4): adds a vertex in base face 0 = (0, 1, 2)
///     record 1 (vertex 5): adds one in the rest of face 0; depends on record 0
///     record 2 (vertex 6): splits base faces 1 and 3 around vertex 3; depends on nothing
constexpr ModelCounts kCounts{4, 4, 3};
constexpr std::uint32_t kFaces = 16;

VsplitRecord make_record(std::uint32_t id, std::uint32_t parent,
                         std::initializer_list<std::pair<std::uint32_t, FaceState>> fan)
{
    VsplitRecord record;
    record.position_m = {static_cast<float>(id), 0.5F, 0.25F};
    record.parent = {parent};
    record.star[0] = kCounts.face_of({id}, 0);
    record.star[1] = kCounts.face_of({id}, 1);
    record.bucket = {100 + id, 200 + id};
    record.next.fill(kNextExact);
    for (const auto& [face, state] : fan)
    {
        record.before[record.fan_size] = state;
        record.error[2U + record.fan_size] = static_cast<std::uint8_t>(10 * id + 1);
        record.star[2U + record.fan_size++] = {face};
    }
    return record;
}

using CornerIds = std::array<std::uint32_t, 3>;

/// The same corners from the least one.
CornerIds rotated(const std::array<VertexId, 3>& corners)
{
    CornerIds ids{corners[0].value, corners[1].value, corners[2].value};
    std::rotate(ids.begin(), std::min_element(ids.begin(), ids.end()), ids.end());
    return ids;
}

class VertexForestTest : public ::testing::Test
{
protected:
    VertexForestTest()
    {
        const std::array<CornerIds, 4> corners{{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
        for (std::size_t i = 0; i < 4; ++i)
        {
            slots_.base.positions_m[i] = {i == 1 ? 1.0F : 0.0F, i == 2 ? 1.0F : 0.0F,
                                          i == 3 ? 1.0F : 0.0F};
            slots_.base.faces[i] = {
                {VertexId{corners[i][0]}, VertexId{corners[i][1]}, VertexId{corners[i][2]}},
                static_cast<std::uint32_t>(40 + i),
                static_cast<ErrorCode>(i == 2 ? 0 : 50)};
            slots_.base.next[i] = i == 0 ? 0 : i == 2 ? kNextExact : 2;
        }
        page(0) = make_record(0, 0, {{0, FaceState::base()}});
        page(0).next[2] = 1;
        page(1) = make_record(1, 4, {{0, FaceState::after({0}, 2)}});
        page(2) = make_record(2, 3, {{1, FaceState::base()}, {3, FaceState::base()}});
        table_.adopt({0}, 0, 0, 7);
        make_forest({kFaces, 64, 64});
    }

    void make_forest(const TreeCapacities& capacities)
    {
        tree_pool_.emplace(arena_, capacities);
        face_pool_.emplace(arena_, capacities.prims);
        tree_.emplace(*tree_pool_, ModelId{0}, capacities, 0x1p-10F);
        sut_.emplace(arena_, *face_pool_, ModelId{0}, capacities.prims, kCounts, slots_, table_,
                     *tree_);
    }
    /// Expects the forest's faces in the tree, one by one.
    void expect_tree_follows()
    {
        tree_->refit();
        std::vector<ChangedFace> faces;
        for (const auto& [face, corners] : mesh())
        {
            faces.push_back(sut_->describe(sut_->find({face})));
            // Independent of the tree:
            const VertexForest::ActiveFace& active = sut_->face(faces.back().prim);
            for (std::size_t i = 0; i < 3; ++i)
            {
                EXPECT_EQ(faces.back().corners_m[i], sut_->position_of(active.corners[i])) << face;
            }
        }
        EXPECT_EQ(tree_faults(*tree_, faces), "");
    }
    VsplitRecord& page(std::uint32_t record) { return slots_.pages[0].records[record]; }

    /// Active faces by id, with their corners.
    std::map<std::uint32_t, CornerIds> mesh()
    {
        std::map<std::uint32_t, CornerIds> faces;
        for (std::uint32_t face = 0; face < kCounts.face_ids(); ++face)
        {
            if (const PrimId prim = sut_->find({face}); !prim.is_none())
            {
                EXPECT_EQ(sut_->face(prim).id.value, face);
                faces[face] = rotated(sut_->face(prim).corners);
            }
        }
        EXPECT_EQ(faces.size(), sut_->active_faces());
        return faces;
    }
    /// Expects each directed edge once, and its reverse once: closed, oriented, 2-manifold at
    /// edges.
    void expect_closed_manifold()
    {
        std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
        std::set<std::uint32_t> vertices;
        for (const auto& [face, corners] : mesh())
        {
            for (std::size_t i = 0; i < 3; ++i)
            {
                vertices.insert(corners[i]);
                EXPECT_TRUE(edges.insert({corners[i], corners[(i + 1) % 3]}).second) << face;
            }
        }
        for (const auto& [from, to] : edges)
        {
            EXPECT_EQ(edges.count({to, from}), 1U) << from << " " << to;
        }
        EXPECT_EQ(vertices.size() + mesh().size(), edges.size() / 2 + 2) << "Euler";
    }
    /// Legal operations by the dependencies listed above, without the forest.
    static bool may_split(std::uint32_t record, unsigned refined)
    {
        return record != 1 || (refined & 1U) != 0;
    }
    static bool may_merge(std::uint32_t record, unsigned refined)
    {
        return record != 0 || (refined & 2U) == 0;
    }

    ArenaMemory memory_{1U << 18U};
    Arena arena_{memory_.bytes()};
    PageSlots slots_{PageSlots::take(arena_, kCounts, 1, 1)};
    PagePool pages_{arena_, 1};
    PageTable table_{pages_, 0, slots_};
    std::optional<TreePool> tree_pool_;
    std::optional<FacePool> face_pool_;
    std::optional<AbTree> tree_;
    std::optional<VertexForest> sut_;
};

} // namespace

TEST_F(VertexForestTest, starts_with_the_base_mesh)
{
    EXPECT_EQ(sut_->active_faces(), 4U);
    EXPECT_EQ(sut_->refined_records(), 0U);
    expect_tree_follows();
    expect_closed_manifold();
    const PrimId prim = sut_->find({0});
    EXPECT_EQ(sut_->next_of(prim), 0U);
    EXPECT_EQ(sut_->error_of(prim), 50);
    EXPECT_EQ(sut_->describe(prim).bucket, 40U);
    EXPECT_EQ(sut_->corners_of(prim)[1], (Vec3f{1.0F, 0.0F, 0.0F}));
    EXPECT_TRUE(sut_->find({4}).is_none());
}

TEST_F(VertexForestTest, a_split_writes_the_star_as_the_record_says)
{
    ASSERT_EQ(sut_->split({0}), VertexForest::SplitOutcome::done);

    const std::map<std::uint32_t, CornerIds> expected{{0, {1, 2, 4}}, {1, {0, 2, 3}},
                                                      {2, {0, 3, 1}}, {3, {1, 3, 2}},
                                                      {4, {0, 1, 4}}, {5, {0, 4, 2}}};
    EXPECT_EQ(mesh(), expected);
    expect_closed_manifold();
    EXPECT_TRUE(table_.is_refined({0}));
    expect_tree_follows();
    const ChangedFace fan = sut_->describe(sut_->find({0}));
    EXPECT_EQ(fan.error, 1);
    EXPECT_EQ(fan.bucket, 40U);
    EXPECT_EQ(sut_->next_of(sut_->find({0})), 1U);
    const ChangedFace side_b = sut_->describe(sut_->find({5}));
    EXPECT_EQ(side_b.face, FaceId{5});
    EXPECT_EQ(side_b.bucket, 200U);
    EXPECT_EQ(side_b.error, 0);
    EXPECT_EQ(side_b.corners_m[0], page(0).position_m);
}

/// The star of a split is laid out as a block: its faces after the split, and exactly the rows that
/// they use.
TEST_F(VertexForestTest, a_split_lays_its_star_out_as_a_block)
{
    for (const std::uint32_t record : {0U, 1U, 2U})
    {
        SCOPED_TRACE(record);
        VertexForest::StarGeometry star;
        ASSERT_EQ(sut_->split({record}, page(record), star), VertexForest::SplitOutcome::done);

        std::uint32_t rows = 0;
        for (std::uint32_t lanes = star.geometry.faces; lanes != 0; lanes &= lanes - 1)
        {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
            for (const auto& corners : star.geometry.corners)
            {
                rows |= 1U << corners[lane];
            }
            const auto laid_out = block_triangle(star.geometry, lane);
            const auto active = sut_->describe(star.prims[lane]).corners_m;
            EXPECT_TRUE(std::is_permutation(laid_out.begin(), laid_out.end(), active.begin()));
        }
        EXPECT_EQ(std::popcount(star.geometry.faces), page(record).fan_size + 2);
        EXPECT_EQ(star.geometry.vertices, rows);
    }
}

TEST_F(VertexForestTest, a_split_round_two_fan_faces_stays_manifold)
{
    ASSERT_EQ(sut_->split({2}), VertexForest::SplitOutcome::done);

    EXPECT_EQ(sut_->active_faces(), 6U);
    expect_closed_manifold();
    const auto faces = mesh();
    EXPECT_EQ(faces.at(1), (CornerIds{0, 2, 6}));
    EXPECT_EQ(faces.at(3), (CornerIds{1, 6, 2}));
    EXPECT_EQ(faces.at(8), (CornerIds{0, 6, 3}));
    EXPECT_EQ(faces.at(9), (CornerIds{1, 3, 6}));
}

TEST_F(VertexForestTest, every_legal_order_gives_the_same_cut_for_the_same_records)
{
    Random random(50);
    std::map<unsigned, std::pair<std::uint64_t, std::map<std::uint32_t, CornerIds>>> known;
    unsigned refined = 0;
    for (int step = 0; step < 3'000; ++step)
    {
        SCOPED_TRACE(step);
        const std::uint32_t record = random.below(3);
        const unsigned bit = 1U << record;
        if ((refined & bit) != 0)
        {
            ASSERT_EQ(sut_->try_merge({record}), may_merge(record, refined));
            refined &= may_merge(record, refined) ? ~bit : ~0U;
        }
        else
        {
            const bool legal = may_split(record, refined);
            ASSERT_EQ(sut_->missing_dependency(page(record)), legal ? RecordId{} : RecordId{0});
            ASSERT_EQ(sut_->split({record}), legal ? VertexForest::SplitOutcome::done
                                                   : VertexForest::SplitOutcome::inconsistent);
            refined |= legal ? bit : 0U;
        }
        ASSERT_EQ(sut_->refined_records(), static_cast<std::uint32_t>(std::popcount(refined)));
        ASSERT_EQ(table_.is_refined({record}), (refined & bit) != 0);
        ASSERT_EQ(sut_->active_faces(), 4 + 2 * sut_->refined_records());
        const auto [entry, is_new] = known.insert({refined, {sut_->state_hash(), mesh()}});
        ASSERT_EQ(entry->second.first, sut_->state_hash()) << refined;
        ASSERT_EQ(entry->second.second, mesh()) << refined;
        ASSERT_NO_FATAL_FAILURE(expect_tree_follows());
    }
    EXPECT_EQ(sut_->active_faces_max(), 10U);
    EXPECT_EQ(known.size(), 6U);
    std::set<std::uint64_t> hashes;
    for (const auto& [set, state] : known)
    {
        hashes.insert(state.first);
    }
    EXPECT_EQ(hashes.size(), 6U) << "different cuts have different hashes";
}

TEST_F(VertexForestTest, an_inconsistent_record_changes_nothing)
{
    const std::vector<VsplitRecord> wrong{
        make_record(2, 3,
                    {{1, FaceState::base()}, {2, FaceState::base()}}), // The fan does not chain.
        make_record(2, 3, {{1, FaceState::base()}, {1, FaceState::base()}}), // Duplicate face.
        make_record(2, 3, {{0, FaceState::base()}}),        // The parent is no corner.
        make_record(2, 3, {{1, FaceState::after({0}, 2)}}), // Wrong state.
        make_record(2, 3, {{1, FaceState::base()}, {7, FaceState::base()}}), // Inactive.
    };
    const std::uint64_t hash = sut_->state_hash();
    const auto before = mesh();
    for (std::size_t i = 0; i < wrong.size(); ++i)
    {
        page(2) = wrong[i];
        EXPECT_EQ(sut_->split({2}), VertexForest::SplitOutcome::inconsistent) << i;
        EXPECT_EQ(sut_->state_hash(), hash) << i;
        EXPECT_EQ(mesh(), before) << i;
        expect_tree_follows();
        EXPECT_FALSE(table_.is_refined({2})) << i;
    }
}

TEST_F(VertexForestTest, a_full_pool_refuses_and_changes_nothing)
{
    make_forest({5, 64, 64}); // One free slot; a split needs two.
    const std::uint64_t hash = sut_->state_hash();

    EXPECT_EQ(sut_->split({0}), VertexForest::SplitOutcome::full);

    EXPECT_EQ(sut_->state_hash(), hash);
    EXPECT_EQ(sut_->active_faces(), 4U);
    EXPECT_FALSE(table_.is_refined({0}));
    make_forest({6, 64, 64});
    EXPECT_EQ(sut_->split({0}), VertexForest::SplitOutcome::done);
    EXPECT_EQ(sut_->split({2}), VertexForest::SplitOutcome::full);
    EXPECT_TRUE(sut_->try_merge({0}));
    EXPECT_EQ(sut_->split({2}), VertexForest::SplitOutcome::done);
}

TEST_F(VertexForestTest, an_unlinked_or_absent_record_is_not_found)
{
    PagePool pages(arena_, 1);
    PageTable table(pages, 0, slots_);
    table.adopt({0}, 0, 0, 0b101);
    EXPECT_NE(table.find_linked({0}), nullptr);
    EXPECT_EQ(table.find_linked({1}), nullptr);
    EXPECT_EQ(table.find_linked({64}), nullptr);
    EXPECT_DEATH(static_cast<void>(sut_->split({64})), "");
}

TEST_F(VertexForestTest, a_border_record_adds_one_face_only)
{
    page(2).star[0] = FaceId{};

    ASSERT_EQ(sut_->split({2}), VertexForest::SplitOutcome::done);
    EXPECT_EQ(sut_->active_faces(), 5U);
    EXPECT_TRUE(sut_->find({8}).is_none());
    EXPECT_FALSE(sut_->find({9}).is_none());
    EXPECT_TRUE(sut_->try_merge({2}));
    EXPECT_EQ(sut_->active_faces(), 4U);
}

TEST_F(VertexForestTest, faces_without_a_place_in_the_tree_are_split_and_merged_all_the_same)
{
    make_forest({kFaces, 4, 4}); // Below its reserve.
    const auto before = mesh();
    const std::uint64_t hash = sut_->state_hash();

    ASSERT_EQ(sut_->split({0}), VertexForest::SplitOutcome::done);

    EXPECT_FALSE(tree_->is_complete());
    expect_tree_follows();
    EXPECT_TRUE(sut_->try_merge({0}));
    EXPECT_EQ(mesh(), before);
    EXPECT_EQ(sut_->state_hash(), hash);
}

} // namespace tactus::test
