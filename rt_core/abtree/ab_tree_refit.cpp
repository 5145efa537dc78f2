// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/base/assert.hpp"

/// Refit of the AB-Tree.
namespace tactus
{

AbTree::RefitWork AbTree::refit() noexcept
{
    RefitWork work;
    // Nodes come first: `link` serves the list of marked nodes, then the lists of levels.
    while (marked_node_ != kNoNode)
    {
        const std::uint32_t index = marked_node_;
        marked_node_ = nodes_[index].link;
        nodes_[index].is_marked = false;
        if (nodes_[index].in_use)
        {
            enqueue(index);
        }
        else
        {
            pool_->give_back_node(share_, index);
        }
    }
    while (marked_block_ != kNoNode)
    {
        const std::uint32_t index = marked_block_;
        BlockSide& side = sides_[index];
        marked_block_ = side.link;
        side.is_marked = false;
        if (side.in_use)
        {
            ++work.blocks;
            pass_up(side.parent, side.child, refitted_box(index),
                    {side.coarse != 0, side.coarse != blocks_[index].faces});
        }
        else
        {
            pool_->give_back_block(share_, index);
        }
    }
    for (std::uint32_t& head : dirty_heads_)
    {
        // A parent's level is higher than its children's, so it is visited after all of them.
        while (head != kNoNode)
        {
            AbNode& node = nodes_[head];
            head = node.link;
            node.is_queued = false;
            ++work.nodes;
            TACTUS_ASSERT(node.in_use);
            if (node.parent != kNoNode)
            {
                TACTUS_ASSERT(nodes_[node.parent].shift > node.shift);
                pass_up(node.parent, node.child,
                        AabbVolume::of_children(*kernels_, node.volumes, node.mask), node.below());
            }
        }
    }
    return work;
}

Aabb AbTree::refitted_box(std::uint32_t index) noexcept
{
    const BlockGeometry& block = blocks_[index];
    const Aabb box =
        AabbVolume::of_vertices(*kernels_, block.coordinates.front().data(), block.vertices);
    const BlockSide& side = sides_[index];
    return side.coarse == 0 ? box : box.inflated(largest_error_quanta(side) * quantum_m_);
}

void AbTree::pass_up(std::uint32_t parent, std::uint32_t child, const Aabb& box,
                     FacesBelow faces) noexcept
{
    if (parent == kNoNode)
    {
        return;
    }
    AbNode& node = nodes_[parent];
    TACTUS_ASSERT(((std::uint32_t{node.mask} >> child) & 1U) != 0);
    if (node.box_of(child) == box && node.below(child) == faces)
    {
        return;
    }
    node.volumes.set(child, box);
    node.set_below(child, faces);
    enqueue(parent);
}

/// Returns to the pool the blocks and nodes that were freed while they waited for refit.
void AbTree::give_back_freed() noexcept
{
    for (std::uint32_t* at = &marked_block_; *at != kNoNode;)
    {
        BlockSide& side = sides_[*at];
        if (side.in_use)
        {
            at = &side.link;
            continue;
        }
        side.is_marked = false;
        pool_->give_back_block(share_, std::exchange(*at, side.link));
    }
    for (std::uint32_t* at = &marked_node_; *at != kNoNode;)
    {
        AbNode& node = nodes_[*at];
        if (node.in_use)
        {
            at = &node.link;
            continue;
        }
        node.is_marked = false;
        pool_->give_back_node(share_, std::exchange(*at, node.link));
    }
}

void AbTree::mark_all() noexcept
{
    for (std::uint32_t i = 0; i < sides_.size(); ++i)
    {
        if (is_block_in_use(i))
        {
            mark(TreeRef::to_block(i));
        }
    }
    for (std::uint32_t i = 0; i < nodes_.size(); ++i)
    {
        if (is_node_in_use(i))
        {
            mark(TreeRef::to_node(i));
        }
    }
}

/// Adds a node to refit's list of the node's level unless it is listed.
void AbTree::enqueue(std::uint32_t index) noexcept
{
    AbNode& node = nodes_[index];
    if (!node.is_queued)
    {
        node.is_queued = true;
        node.link = std::exchange(dirty_heads_[node.shift / 3U], index);
    }
}

Aabb AbTree::box() const noexcept
{
    if (root_.is_none())
    {
        return Aabb{};
    }
    const std::uint32_t index = root_.index();
    if (!root_.is_block())
    {
        return AabbVolume::of_children(*kernels_, nodes_[index].volumes, nodes_[index].mask);
    }
    const BlockGeometry& block = blocks_[index];
    const Aabb box =
        AabbVolume::of_vertices(*kernels_, block.coordinates.front().data(), block.vertices);
    return box.inflated(largest_error_quanta(sides_[index]) * quantum_m_);
}

Aabb AbTree::box_of(TreeRef ref) const noexcept
{
    const std::uint32_t index = ref.index();
    const std::uint32_t parent = ref.is_block() ? sides_[index].parent : nodes_[index].parent;
    return parent == kNoNode
               ? box()
               : nodes_[parent].box_of(ref.is_block() ? sides_[index].child : nodes_[index].child);
}

NodeStatus AbTree::status(TreeRef ref) const noexcept
{
    const std::uint32_t index = ref.index();
    const bool in_use = ref.is_block() ? is_block_in_use(index) : is_node_in_use(index);
    if (!in_use)
    {
        return NodeStatus::inactive;
    }
    const bool marked = ref.is_block() ? sides_[index].is_marked : nodes_[index].is_marked;
    return marked ? NodeStatus::deformed : NodeStatus::active;
}

} // namespace tactus
