// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/base/flaw.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstdint>

namespace tactus
{

/// Checks an AB-AbTree against its invariants after refit():
///
///     free lists   of the pool hold exactly what no tree uses, each once
///     links        a child and its parent name each other; a parent's digit is above its child's;
///                  only the root has no parent. So everything in use hangs below the root.
///     paths        every face lies where the digits of its path lead
///     faces        each placed one is in one lane, and its prim says in which
///     boxes        a parent has its child's box, which holds every face inflated by its error
///
/// Each block, node and prim is visited once, without recursion or memory. The check trusts the
/// kernels that compute boxes; the tests' own oracle does not.
class TreeValidator
{
public:
    [[nodiscard]] static Flaw find_flaw(const AbTree& tree) noexcept TACTUS_NONBLOCKING
    {
        TreeValidator validator(tree);
        validator.check_free_blocks();
        validator.check_free_nodes();
        validator.check_counts();
        validator.check_work_is_done();
        // The next checks follow links, so they run only while no flaw was found.
        for (std::uint32_t i = 0; validator.is_sound() && i < tree.sides_.size(); ++i)
        {
            validator.check_block(i);
        }
        for (std::uint32_t i = 0; validator.is_sound() && i < tree.nodes_.size(); ++i)
        {
            validator.check_node(i);
        }
        for (std::uint32_t i = 0; validator.is_sound() && i < tree.prims_.size(); ++i)
        {
            validator.check_prim(i);
        }
        validator.check_unplaced();
        return validator.finder_.first();
    }

private:
    explicit TreeValidator(const AbTree& tree) noexcept : tree_(tree) {}

    [[nodiscard]] bool is_sound() const noexcept { return finder_.is_sound(); }
    bool block(bool holds, std::uint32_t index, const char* what) noexcept
    {
        return finder_.expect(holds, "block", index, what);
    }
    bool node(bool holds, std::uint32_t index, const char* what) noexcept
    {
        return finder_.expect(holds, "node", index, what);
    }
    bool prim(bool holds, std::uint32_t index, const char* what) noexcept
    {
        return finder_.expect(holds, "prim", index, what);
    }

    void check_free_blocks() noexcept
    {
        const auto& pool = *tree_.pool_;
        const std::uint32_t free = pool.capacities().blocks - pool.block_room_.used();
        std::uint32_t listed = 0;
        for (std::uint32_t i = pool.free_block_; i != kNoNode; i = tree_.sides_[i].parent, ++listed)
        {
            if (!block(i < tree_.sides_.size(), i, "is free and out of range") ||
                !block(!tree_.sides_[i].in_use, i, "is in use and free") ||
                !block(listed < free, i, "is in a free list that is too long"))
            {
                return;
            }
        }
        const auto in_use = static_cast<std::uint32_t>(
            std::ranges::count_if(tree_.sides_, [](const BlockSide& side) { return side.in_use; }));
        finder_.expect(listed == free, "tree", listed,
                       "blocks are in its pool's free list, but the pool's count differs");
        finder_.expect(listed + in_use == pool.capacities().blocks, "tree", in_use,
                       "blocks are in use, but others are neither in use nor free");
    }

    void check_free_nodes() noexcept
    {
        const auto& pool = *tree_.pool_;
        const std::uint32_t free = pool.capacities().nodes - pool.node_room_.used();
        std::uint32_t listed = 0;
        for (std::uint32_t i = pool.free_node_; i != kNoNode; i = tree_.nodes_[i].parent, ++listed)
        {
            if (!node(i < tree_.nodes_.size(), i, "is free and out of range") ||
                !node(!tree_.nodes_[i].in_use, i, "is in use and free") ||
                !node(listed < free, i, "is in a free list that is too long"))
            {
                return;
            }
        }
        const auto in_use = static_cast<std::uint32_t>(
            std::ranges::count_if(tree_.nodes_, [](const AbNode& each) { return each.in_use; }));
        finder_.expect(listed == free, "tree", listed,
                       "nodes are in its pool's free list, but the pool's count differs");
        finder_.expect(listed + in_use == pool.capacities().nodes, "tree", in_use,
                       "nodes are in use, but others are neither in use nor free");
    }

    /// Counts blocks and nodes that name the tree as their owner.
    void check_counts() noexcept
    {
        const auto is_own = [this](const auto& each)
        { return each.in_use && each.owner == tree_.owner_; };
        const auto blocks = static_cast<std::uint32_t>(std::ranges::count_if(tree_.sides_, is_own));
        const auto nodes = static_cast<std::uint32_t>(std::ranges::count_if(tree_.nodes_, is_own));
        finder_.expect(blocks == tree_.blocks_used_ && blocks == tree_.share_.blocks.used, "tree",
                       blocks, "blocks are its own, but its count differs");
        finder_.expect(nodes == tree_.nodes_used_ && nodes == tree_.share_.nodes.used, "tree",
                       nodes, "nodes are its own, but its count differs");
    }

    void check_work_is_done() noexcept
    {
        block(tree_.marked_block_ == kNoNode, tree_.marked_block_, "waits for refit");
        node(tree_.marked_node_ == kNoNode, tree_.marked_node_, "waits for refit");
        for (const std::uint32_t head : tree_.dirty_heads_)
        {
            node(head == kNoNode, head, "waits for refit");
        }
        if (!tree_.root_.is_none())
        {
            finder_.expect(is_in_use(tree_.root_), "tree", tree_.root_.value, "has no such root");
        }
    }

    [[nodiscard]] bool is_in_use(TreeRef ref) const noexcept
    {
        const std::uint32_t index = ref.index();
        return ref.is_block() ? tree_.is_block_in_use(index) : tree_.is_node_in_use(index);
    }

    /// True if `parent` has `ref` as its child; without a parent, if it is the root.
    [[nodiscard]] bool is_linked(TreeRef ref, std::uint32_t parent,
                                 std::uint32_t child) const noexcept
    {
        if (parent == kNoNode)
        {
            return tree_.root_ == ref;
        }
        return is_in_use(TreeRef::to_node(parent)) && child < kNodeChildren &&
               ((std::uint32_t{tree_.nodes_[parent].mask} >> child) & 1U) != 0 &&
               tree_.nodes_[parent].children[child] == ref;
    }
    [[nodiscard]] bool leads_to(std::uint32_t parent, std::uint32_t child,
                                std::uint64_t path) const noexcept
    {
        const AbNode& above = tree_.nodes_[parent];
        return above.holds(path) && above.child_of(above.digit_of(path)) == child;
    }

    void check_block(std::uint32_t index) noexcept
    {
        const BlockSide& side = tree_.sides_[index];
        const BlockGeometry& geometry = tree_.blocks_[index];
        block(!side.is_marked || side.owner != tree_.owner_, index, "is marked after refit");
        if (!tree_.is_block_in_use(index))
        {
            return;
        }
        block(geometry.faces != 0, index, "is in use and empty");
        if (!block(is_linked(TreeRef::to_block(index), side.parent, side.child), index,
                   "is not linked from its parent"))
        {
            return;
        }
        const Aabb box = refitted_box(index);
        std::uint32_t rows = 0;
        std::uint32_t coarse = 0;
        for (std::uint32_t lanes = geometry.faces; lanes != 0; lanes &= lanes - 1)
        {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
            coarse |= side.errors[lane] != 0 ? 1U << lane : 0U;
            for (const std::array<std::uint8_t, kBlockFaces>& corners : geometry.corners)
            {
                block(corners[lane] < kBlockVertices, index, "has a face without a vertex");
                rows |= 1U << (corners[lane] % kBlockVertices);
            }
            check_lane(index, lane);
            check_is_inside(box, index, lane);
        }
        block(geometry.vertices == rows, index, "has vertices that differ from those of its faces");
        coarse |= side.outdated;
        block((side.outdated & ~std::uint32_t{geometry.faces}) == 0, index,
              "has outdated bits without a face");
        block(side.coarse == coarse, index, "has wrong coarse bits");
        if (side.parent != kNoNode)
        {
            const AbNode& parent = tree_.nodes_[side.parent];
            block(parent.box_of(side.child) == box, index, "has another box at its parent");
            block(parent.below(side.child) == FacesBelow{coarse != 0, coarse != geometry.faces},
                  index, "has a wrong coarse or exact bit at its parent");
        }
    }

    void check_lane(std::uint32_t index, std::uint32_t lane) noexcept
    {
        const BlockSide& side = tree_.sides_[index];
        const std::uint32_t value = side.prims[lane].value;
        if (!block(value < tree_.prims_.size(), index, "holds a prim that does not exist") ||
            !prim(tree_.prims_[value].leaf == index * kBlockFaces + lane, value,
                  "names another lane"))
        {
            return;
        }
        const auto& known = tree_.prims_[value];
        if (side.parent != kNoNode)
        {
            prim(leads_to(side.parent, side.child, AbTree::path_of(known.face, known.bucket)),
                 value, "lies off its path");
        }
    }

    [[nodiscard]] Aabb refitted_box(std::uint32_t index) const noexcept
    {
        const BlockGeometry& geometry = tree_.blocks_[index];
        const Aabb box = AabbVolume::of_vertices(
            *tree_.kernels_, geometry.coordinates.front().data(), geometry.vertices);
        const BlockSide& side = tree_.sides_[index];
        return side.coarse == 0 ? box : box.inflated(largest_error_quanta(side) * tree_.quantum_m_);
    }

    /// Checks that a block's box holds a face and its error; other volumes than Aabb are not
    /// checked.
    void check_is_inside(const Aabb& box, std::uint32_t index, std::uint32_t lane) noexcept
    {
        if constexpr (std::same_as<Aabb, Aabb>)
        {
            const double error =
                static_cast<double>(error_in_quanta(tree_.sides_[index].errors[lane])) *
                static_cast<double>(tree_.quantum_m_);
            for (const Vec3f& corner : block_triangle(tree_.blocks_[index], lane))
            {
                for (std::size_t axis = 0; axis < 3; ++axis)
                {
                    const auto at = static_cast<double>(corner[axis]);
                    block(at - error >= static_cast<double>(box.low[axis]) &&
                              at + error <= static_cast<double>(box.high[axis]),
                          index, "has a box that does not hold a face");
                }
            }
        }
    }

    void check_node(std::uint32_t index) noexcept
    {
        const AbNode& own = tree_.nodes_[index];
        node((!own.is_marked && !own.is_queued) || own.owner != tree_.owner_, index,
             "is marked after refit");
        if (!tree_.is_node_in_use(index))
        {
            return;
        }
        node(own.shift % 3 == 0 && own.shift / 3U < kTreeLevels, index, "has no octal digit");
        node(own.child_count() >= 2, index, "has fewer than two children");
        node(((own.coarse | own.exact) & ~own.mask) == 0, index, "has faces below a missing child");
        check_children(index);
        check_digits(index);
        if (!node(is_linked(TreeRef::to_node(index), own.parent, own.child), index,
                  "is not linked from its parent") ||
            own.parent == kNoNode)
        {
            return;
        }
        const AbNode& parent = tree_.nodes_[own.parent];
        node(parent.shift > own.shift, index, "is not below its parent's digit");
        node(leads_to(own.parent, own.child, own.prefix), index, "lies off its path");
        node(parent.box_of(own.child) ==
                 AabbVolume::of_children(*tree_.kernels_, own.volumes, own.mask),
             index, "has another box at its parent");
        node(parent.below(own.child) == own.below(), index,
             "has a wrong coarse or exact bit at its parent");
    }

    void check_children(std::uint32_t index) noexcept
    {
        const AbNode& own = tree_.nodes_[index];
        for (std::uint32_t child = 0; child < kNodeChildren; ++child)
        {
            const TreeRef ref = own.children[child];
            const bool is_used = ((std::uint32_t{own.mask} >> child) & 1U) != 0;
            if (!node(is_used == !ref.is_none(), index,
                      "has a mask that differs from its children") ||
                !is_used || !node(is_in_use(ref), index, "has a child that is not in use"))
            {
                continue;
            }
            const std::uint32_t at = ref.index();
            node(ref.is_block() ? is_linked(ref, tree_.sides_[at].parent, tree_.sides_[at].child)
                                : is_linked(ref, tree_.nodes_[at].parent, tree_.nodes_[at].child),
                 index, "has a child that is linked elsewhere");
        }
    }

    /// Checks that each child has one aligned range of 1, 2 or 4 digits, and a child node one
    /// digit.
    void check_digits(std::uint32_t index) noexcept
    {
        const AbNode& own = tree_.nodes_[index];
        std::uint32_t reached = 0;
        for (std::uint32_t digit = 0; digit < kNodeChildren; ++digit)
        {
            const std::uint32_t child = own.child_of(digit);
            node(child <= AbNode::kNoChild, index, "has a digit without a child");
            reached |= child < kNodeChildren ? 1U << child : 0U;
        }
        if (!node(reached == own.mask, index, "has digits that name other children"))
        {
            return;
        }
        for (std::uint32_t left = own.mask; left != 0; left &= left - 1)
        {
            const auto child = static_cast<std::uint32_t>(std::countr_zero(left));
            const DigitRange range = own.range_of(child);
            node(std::has_single_bit(range.width) && range.first % range.width == 0 &&
                     own.only_child_in(range) == child && range.width < kNodeChildren,
                 index, "has a child without an aligned cell");
            node(own.children[child].is_block() || range.width == 1, index,
                 "has a child node of several digits");
        }
    }

    void check_prim(std::uint32_t index) noexcept
    {
        const auto& own = tree_.prims_[index];
        if (own.leaf == AbTree::kNoLeaf)
        {
            prim(own.face.is_none(), index, "has a face and no place");
            return;
        }
        prim(!own.face.is_none(), index, "has a place and no face");
        const std::uint32_t at = own.leaf / kBlockFaces;
        const std::uint32_t lane = own.leaf % kBlockFaces;
        if ((own.leaf & AbTree::kUnplaced) != 0 ||
            (at < tree_.sides_.size() && tree_.sides_[at].owner != tree_.owner_))
        {
            return; // The face is unplaced, or of another tree.
        }
        prim(tree_.is_block_in_use(at) &&
                 ((std::uint32_t{tree_.blocks_[at].faces} >> lane) & 1U) != 0 &&
                 tree_.sides_[at].prims[lane].value == index,
             index, "is not in the lane that it names");
    }

    void check_unplaced() noexcept
    {
        std::uint32_t listed = 0;
        for (std::uint32_t i = tree_.first_unplaced_; is_sound() && i != AbTree::kLastUnplaced;)
        {
            if (prim(i < tree_.prims_.size(), i, "is unplaced and out of range") &&
                prim(tree_.is_unplaced({i}), i, "is placed and in the list of the unplaced") &&
                prim(++listed <= tree_.prims_.size(), i, "is twice in the list of the unplaced"))
            {
                i = tree_.prims_[i].leaf & ~AbTree::kUnplaced;
            }
        }
    }

    const AbTree& tree_;
    FlawFinder finder_;
};

[[nodiscard]] inline Flaw find_flaw(const AbTree& tree) noexcept TACTUS_NONBLOCKING
{
    return TreeValidator::find_flaw(tree);
}

} // namespace tactus
