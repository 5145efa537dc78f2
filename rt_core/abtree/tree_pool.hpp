// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/block.hpp"
#include "rt_core/abtree/node.hpp"
#include "rt_core/base/arena.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/base/model_id.hpp"
#include "rt_core/base/pool_room.hpp"

#include <cstdint>
#include <span>
#include <utility>

namespace tactus
{

/// Capacities of a pool of trees, or the part of one tree.
struct TreeCapacities
{
    std::uint32_t prims{0};
    std::uint32_t blocks{0};
    std::uint32_t nodes{0};
};

/// Reserved and used blocks and nodes of one tree in a pool.
struct TreeShare
{
    PoolShare blocks;
    PoolShare nodes;
};

class TreeValidator;

/// A face of a tree, or a free entry (`face` is none).
struct TreePrim
{
    static constexpr std::uint32_t kNoLeaf = 0xFFFF'FFFFU;

    FaceId face{};
    std::uint32_t bucket{0};
    /// Block x 16 + lane of a placed face; kNoLeaf of a free entry. With the highest bit set the
    /// face is unplaced, and the other bits are the tree's next unplaced prim.
    std::uint32_t leaf{kNoLeaf};
};

/// The memory of AB-Trees. A tree's blocks and nodes lie anywhere in it.
/// The creator of the faces assigns the prims. 352 B a block, 256 B a node with boxes, 12 B a prim.
///
/// Haptic thread only.
class TreePool
{
public:
    /// Largest number of blocks: a face's place, block x 16 + lane, has 31 bits.
    static constexpr std::uint32_t kMostBlocks = 0x8000'0000U / kBlockFaces;

    TreePool(Arena& arena, const TreeCapacities& capacities) noexcept
        : blocks_(arena.take<BlockGeometry>(capacities.blocks))
        , sides_(arena.take<BlockSide>(capacities.blocks))
        , nodes_(arena.take<AbNode>(capacities.nodes))
        , prims_(arena.take<TreePrim>(capacities.prims))
        , block_room_(capacities.blocks)
        , node_room_(capacities.nodes)
    {
        if (arena.is_measuring())
        {
            return;
        }
        TACTUS_ASSERT(capacities.blocks <= kMostBlocks);
        TACTUS_ASSERT(capacities.prims <= kMaxPoolFaces);
        for (std::uint32_t i = capacities.blocks; i-- > 0;)
        {
            sides_[i].parent = std::exchange(free_block_, i);
        }
        for (std::uint32_t i = capacities.nodes; i-- > 0;)
        {
            nodes_[i].parent = std::exchange(free_node_, i);
        }
    }

    /// Number of the next change in any of its trees; from 1.
    [[nodiscard]] std::uint64_t next_change() noexcept { return ++changes_; }

    /// Reserves blocks and nodes for a new tree, or as many as are not reserved for others.
    [[nodiscard]] TreeShare promise(const TreeCapacities& least) noexcept
    {
        return {block_room_.promise(least.blocks), node_room_.promise(least.nodes)};
    }
    /// Reserves blocks and nodes for a tree without a reservation. False, with nothing changed, if
    /// too few are neither taken nor reserved.
    [[nodiscard]] bool try_promise(TreeShare& share, const TreeCapacities& least) noexcept
    {
        if (!block_room_.try_promise(share.blocks, least.blocks))
        {
            return false;
        }
        if (!node_room_.try_promise(share.nodes, least.nodes))
        {
            block_room_.end_promise(share.blocks);
            return false;
        }
        return true;
    }
    void end_promise(TreeShare& share) noexcept
    {
        block_room_.end_promise(share.blocks);
        node_room_.end_promise(share.nodes);
    }
    /// True if a tree may take `count` blocks and as many nodes.
    [[nodiscard]] bool has_room_for(const TreeShare& share, std::uint32_t count) const noexcept
    {
        return block_room_.left_for(share.blocks) >= count &&
               node_room_.left_for(share.nodes) >= count;
    }

    /// Takes an empty block for a tree that has room for one (asserted).
    [[nodiscard]] std::uint32_t take_block(TreeShare& share, ModelId owner) noexcept
    {
        block_room_.take(share.blocks);
        const std::uint32_t block = free_block_;
        TACTUS_ASSERT(!sides_[block].in_use);
        TACTUS_ASSERT(!sides_[block].is_marked);
        free_block_ = sides_[block].parent;
        blocks_[block].faces = 0;
        blocks_[block].vertices = 0;
        sides_[block] = BlockSide{};
        sides_[block].in_use = true;
        sides_[block].owner = static_cast<std::uint8_t>(owner.value);
        return block;
    }
    /// Takes a node without children for a tree that has room for one (asserted).
    [[nodiscard]] std::uint32_t take_node(TreeShare& share, ModelId owner) noexcept
    {
        node_room_.take(share.nodes);
        const std::uint32_t node = free_node_;
        TACTUS_ASSERT(!nodes_[node].in_use);
        TACTUS_ASSERT(!nodes_[node].is_marked);
        free_node_ = nodes_[node].parent;
        nodes_[node] = AbNode{};
        nodes_[node].in_use = true;
        nodes_[node].owner = static_cast<std::uint8_t>(owner.value);
        return node;
    }
    /// Returns a block that is in no list of the tree.
    void give_back_block(TreeShare& share, std::uint32_t block) noexcept
    {
        TACTUS_ASSERT(!sides_[block].in_use);
        TACTUS_ASSERT(!sides_[block].is_marked);
        block_room_.give_back(share.blocks);
        sides_[block].parent = std::exchange(free_block_, block);
    }
    void give_back_node(TreeShare& share, std::uint32_t node) noexcept
    {
        TACTUS_ASSERT(!nodes_[node].in_use);
        TACTUS_ASSERT(!nodes_[node].is_marked);
        node_room_.give_back(share.nodes);
        nodes_[node].parent = std::exchange(free_node_, node);
    }

    [[nodiscard]] std::span<BlockGeometry> blocks() const noexcept { return blocks_; }
    [[nodiscard]] std::span<BlockSide> sides() const noexcept { return sides_; }
    [[nodiscard]] std::span<AbNode> nodes() const noexcept { return nodes_; }
    [[nodiscard]] std::span<TreePrim> prims() const noexcept { return prims_; }
    [[nodiscard]] TreeCapacities capacities() const noexcept
    {
        return {static_cast<std::uint32_t>(prims_.size()), block_room_.capacity(),
                node_room_.capacity()};
    }

private:
    friend class TreeValidator;

    std::span<BlockGeometry> blocks_;
    std::span<BlockSide> sides_;
    std::span<AbNode> nodes_;
    std::span<TreePrim> prims_;
    PoolRoom block_room_;
    PoolRoom node_room_;
    std::uint32_t free_block_{kNoNode}; ///< First free block; free ones are linked by `parent`.
    std::uint32_t free_node_{kNoNode};
    std::uint64_t changes_{0};
};

} // namespace tactus
