// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/model_pieces.hpp"
#include "tests/unit/rt_core/tree_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <unordered_set>
#include <utility>
#include <vector>

/// The 3DIM 2005 paper's lemma: refitting a tree of n leaves, b children a node, after k random
/// leaves changed visits at most k (log_b n - log_b k + 2) nodes, leaves included. The upper log_b
/// k levels have fewer than 2 k nodes in all; below them each leaf has its own path.
namespace tactus::test
{

[[nodiscard]] inline double visits_allowed(double k, double levels)
{
    return k * (levels - std::log(k) / std::log(double{kNodeChildren}) + 2.0);
}

/// Finest mesh of a tree test: a height field of columns x rows squares of two exact faces each.
/// Prim and face id are the place in `faces`; `order` lists the places by bucket.
struct FaceGrid
{
    std::vector<ChangedFace> faces;
    std::vector<std::uint32_t> order;
};

[[nodiscard]] inline FaceGrid make_face_grid(std::uint32_t columns, std::uint32_t rows)
{
    QuantisedMesh mesh;
    for (std::uint32_t y = 0; y <= rows; ++y)
    {
        for (std::uint32_t x = 0; x <= columns; ++x)
        {
            mesh.positions.push_back({static_cast<std::int32_t>(x), static_cast<std::int32_t>(y),
                                      static_cast<std::int32_t>((x * 7 + y * 13) % 5)});
            if (x < columns && y < rows)
            {
                const std::uint32_t at = y * (columns + 1) + x;
                const std::uint32_t above = at + columns + 1;
                mesh.faces.push_back({at, at + 1, above + 1});
                mesh.faces.push_back({at, above + 1, above});
            }
        }
    }
    FaceGrid grid;
    const std::vector<std::uint32_t> buckets = left_full_buckets(mesh);
    for (std::uint32_t place = 0; place < mesh.faces.size(); ++place)
    {
        ChangedFace face{PrimId{place}, FaceId{place}, buckets[place], 0, {}};
        for (std::size_t corner = 0; corner < 3; ++corner)
        {
            const auto& at = mesh.positions[mesh.faces[place][corner]];
            face.corners_m[corner] = {static_cast<float>(at[0]), static_cast<float>(at[1]),
                                      static_cast<float>(at[2])};
        }
        grid.faces.push_back(face);
        grid.order.push_back(place);
    }
    std::ranges::stable_sort(grid.order, {}, [&](std::uint32_t face) { return buckets[face]; });
    return grid;
}

/// 8-wide tree over a whole finest mesh, with blocks as leaves.
class GridTree
{
public:
    explicit GridTree(const FaceGrid& grid)
        : rig_(capacities(static_cast<std::uint32_t>(grid.faces.size())))
    {
        for (const std::uint32_t face : grid.order)
        {
            rig_.put(grid.faces[face]);
        }
        rig_.sut->refit();
        std::unordered_set<std::uint32_t> seen;
        for (const std::uint32_t face : grid.order)
        {
            if (seen.insert(block_of(face)).second)
            {
                firsts_.push_back(face);
            }
        }
    }

    [[nodiscard]] std::uint32_t leaves() const
    {
        return static_cast<std::uint32_t>(firsts_.size());
    }
    [[nodiscard]] bool is_complete() const { return rig_.sut->is_complete(); }

    /// Changes one face in each of these leaves (places in path order) so that every box above it
    /// changes as well, refits, and restores everything. Returns the visits of the first refit.
    std::uint64_t visits_of(const std::vector<std::uint32_t>& changed)
    {
        set_errors(changed, kFarReaching);
        const AbTree::RefitWork work = rig_.sut->refit();
        set_errors(changed, 0);
        rig_.sut->refit();
        return std::uint64_t{work.blocks} + work.nodes;
    }

    /// The same number by another way: all nodes reached by the parent links, each once.
    [[nodiscard]] std::uint64_t ancestors_of(const std::vector<std::uint32_t>& changed) const
    {
        std::unordered_set<std::uint32_t> nodes;
        for (const std::uint32_t leaf : changed)
        {
            std::uint32_t node = rig_.sut->side(block_of(firsts_[leaf])).parent;
            for (; node != kNoNode; node = rig_.sut->node(node).parent)
            {
                nodes.insert(node);
            }
        }
        return changed.size() + nodes.size();
    }

private:
    /// Error of 2^41.5 quanta: a box that extends beyond every other.
    static constexpr ErrorCode kFarReaching = 200;

    static TreeCapacities capacities(std::uint32_t faces)
    {
        return {faces, faces / 6 + 2 * AbTree::kReserve, faces / 8 + 2 * AbTree::kReserve};
    }
    [[nodiscard]] std::uint32_t block_of(std::uint32_t face) const
    {
        return rig_.sut->leaf_of(PrimId{face}) / kBlockFaces;
    }
    void set_errors(const std::vector<std::uint32_t>& changed, ErrorCode error)
    {
        for (const std::uint32_t leaf : changed)
        {
            ChangedFace face = rig_.face(firsts_[leaf]);
            face.error = error;
            rig_.put(face);
        }
    }

    TreeRig rig_;
    std::vector<std::uint32_t> firsts_; ///< One face of each block, in path order.
};

[[nodiscard]] inline std::vector<std::uint32_t> random_leaves(Random& random, std::uint32_t count,
                                                              std::uint32_t leaves)
{
    std::unordered_set<std::uint32_t> picked;
    while (picked.size() < count)
    {
        picked.insert(random.below(leaves));
    }
    return {picked.begin(), picked.end()};
}

[[nodiscard]] inline std::vector<std::uint32_t>
neighbouring_leaves(Random& random, std::uint32_t count, std::uint32_t leaves)
{
    std::vector<std::uint32_t> picked(count);
    std::uint32_t leaf = random.below(leaves - count + 1);
    for (std::uint32_t& one : picked)
    {
        one = leaf++;
    }
    return picked;
}

/// Levels log_b n, whole for few changes: a leaf that changes almost alone may lie deeper than the
/// real logarithm. From eight changed leaves on, shared nodes compensate for it.
[[nodiscard]] inline double levels_over(std::uint32_t leaves, std::uint32_t changed)
{
    const double levels = std::log(static_cast<double>(leaves)) / std::log(double{kNodeChildren});
    return changed < 8 ? std::ceil(levels) : levels;
}

/// Checks k = 1 .. 4,096, random and clustered, in the tree over `grid`.
inline void expect_lemma(const FaceGrid& grid, int trials)
{
    GridTree tree(grid);
    ASSERT_TRUE(tree.is_complete());
    Random random(300);
    for (std::uint32_t k = 1; k <= 4'096 && k <= tree.leaves(); k *= 2)
    {
        const double levels = levels_over(tree.leaves(), k);
        for (int trial = 0; trial < trials; ++trial)
        {
            const auto spread = random_leaves(random, k, tree.leaves());
            const auto visits = static_cast<double>(tree.visits_of(spread));
            ASSERT_EQ(visits, static_cast<double>(tree.ancestors_of(spread)));
            EXPECT_LE(visits, visits_allowed(k, levels))
                << grid.faces.size() << " faces, n " << tree.leaves() << ", k " << k;
            const auto cluster = neighbouring_leaves(random, k, tree.leaves());
            const auto clustered = static_cast<double>(tree.visits_of(cluster));
            ASSERT_EQ(clustered, static_cast<double>(tree.ancestors_of(cluster)));
            // A run has two paths to its ends, and between them no more nodes than blocks.
            EXPECT_LE(clustered, 2.0 * k + 2.0 * std::ceil(levels))
                << grid.faces.size() << " faces, n " << tree.leaves() << ", k " << k;
            if (k >= 16 && tree.leaves() >= 64 * k)
            {
                EXPECT_LT(clustered, 0.5 * visits_allowed(k, levels)) << "k " << k;
            }
        }
    }
}

} // namespace tactus::test
