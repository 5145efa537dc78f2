// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/block.hpp"
#include "rt_core/abtree/node.hpp"
#include "rt_core/abtree/tree_pool.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/kernels/kernels.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/changed_face.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace tactus
{

/// States of a node or block, as in the 3DIM 2005 paper: *inactive* ones are not in the tree,
/// *deformed* ones wait for refit.
enum class NodeStatus : std::uint8_t
{
    inactive,
    active,
    deformed,
};

/// The Active Bounding Tree over one model's active faces, in a pool that other trees may share.
///
/// It is a path-compressed radix tree. A face's path is its bucket followed by its id with the bits
/// mixed. The bucket is the upper bits of its rank in the left-full median order of the finest
/// mesh's faces. So paths differ and depend on nothing but the face. Leaves are blocks: the largest
/// binary cells of the path space that hold at most 16 active faces over at most 16 vertices.
/// Binary levels are collapsed into 8-wide nodes. Nodes and blocks exist only where faces are
/// active.
///
/// Changes are made face by face. refit() then updates the boxes. It visits deformed blocks and
/// nodes only, level by level from below, and stops where a box did not change. A box holds its
/// faces inflated by their error bounds. So a face's distance minus its error is never less than
/// the distance of any box around it.
///
/// If the pool is exhausted a face stays *unplaced*: is_complete() is then false and a query may
/// prove nothing. The caller offers unplaced faces again in later frames.
///
/// A block or node freed while it waits for refit() returns to the pool there at the latest.
///
/// All memory is the pool's.
///
/// Haptic thread only.
class AbTree
{
public:
    struct RefitWork
    {
        std::uint32_t blocks{0};
        std::uint32_t nodes{0};
    };

    /// TreePool and kernels must outlive the tree. `least` blocks and nodes are reserved for it in
    /// the pool, or as many as are free. Each tree of a pool has another `owner`, below kMaxModels.
    AbTree(TreePool& pool, ModelId owner, const TreeCapacities& least, float quantum_m,
           const Kernels& kernels = best_kernels()) noexcept;

    /// Adds a face. No tree of the pool may have a face with the same prim (asserted).
    void insert(const ChangedFace& face) noexcept TACTUS_NONBLOCKING;

    /// Moves one corner (0 .. 2) of a face and changes its error, for fan faces of splits and
    /// merges: cheaper than removal and insertion. The face is not outdated afterwards. No effect
    /// on an unplaced face.
    void move_corner(PrimId prim, std::uint32_t corner, const Vec3f& position_m,
                     ErrorCode error) noexcept TACTUS_NONBLOCKING;

    /// Marks these lanes of a block in use as outdated (ChangedFace::is_outdated).
    void outdate(std::uint32_t block, std::uint32_t lanes) noexcept TACTUS_NONBLOCKING;

    /// Removes the prim's face, placed or not.
    void remove(PrimId prim) noexcept TACTUS_NONBLOCKING;

    /// Marks all blocks and nodes of the tree for refit().
    void mark_all() noexcept TACTUS_NONBLOCKING;

    /// Updates the boxes of marked blocks and nodes, and of all nodes above them whose boxes
    /// change. Visits each at most once.
    RefitWork refit() noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] bool is_complete() const noexcept { return first_unplaced_ == kLastUnplaced; }
    [[nodiscard]] bool is_unplaced(PrimId prim) const noexcept
    {
        TACTUS_ASSERT(prim.value < prims_.size());
        const std::uint32_t leaf = prims_[prim.value].leaf;
        return (leaf & kUnplaced) != 0 && leaf != kNoLeaf;
    }
    /// Tries to place each unplaced face; `describe(prim)` returns its present ChangedFace.
    template <typename Describe>
    void offer_unplaced(const Describe& describe) noexcept
    {
        if (is_complete())
        {
            return;
        }
        give_back_freed();
        std::uint32_t index = std::exchange(first_unplaced_, kLastUnplaced);
        while (index != kLastUnplaced)
        {
            TACTUS_ASSERT(is_unplaced(PrimId{index}));
            const std::uint32_t next = prims_[index].leaf & ~kUnplaced;
            prims_[index].leaf = kNoLeaf;
            insert(describe(PrimId{index}));
            index = next;
        }
    }
    /// Any face in the tree, placed or not, found without a search. None if the tree is empty.
    [[nodiscard]] PrimId any_prim() const noexcept TACTUS_NONBLOCKING;
    /// Reserves blocks and nodes in the pool for an empty tree without a reservation. False, with
    /// nothing changed, if the pool has too few.
    [[nodiscard]] bool try_promise(const TreeCapacities& least) noexcept TACTUS_NONBLOCKING
    {
        return pool_->try_promise(share_, least);
    }
    /// Ends the tree's reservation. The tree must be empty, and refitted since its last removal.
    void end_promise() noexcept TACTUS_NONBLOCKING { pool_->end_promise(share_); }
    /// Blocks and nodes that one more changed face may need at worst.
    static constexpr std::uint32_t kReserve = kBlockFaces + 1;
    [[nodiscard]] bool has_room_for(std::uint32_t changed_faces) const noexcept TACTUS_NONBLOCKING;

    /// Number of the tree's last change, unique in the pool. Distances proven for the tree hold
    /// while the number stays the same.
    [[nodiscard]] std::uint64_t last_change() const noexcept { return last_change_; }
    [[nodiscard]] TreeRef root() const noexcept { return root_; }
    [[nodiscard]] const AbNode& node(std::uint32_t index) const noexcept { return nodes_[index]; }
    [[nodiscard]] const BlockGeometry& block(std::uint32_t index) const noexcept
    {
        return blocks_[index];
    }
    [[nodiscard]] const BlockSide& side(std::uint32_t index) const noexcept
    {
        return sides_[index];
    }
    [[nodiscard]] bool is_block_in_use(std::uint32_t index) const noexcept
    {
        return index < sides_.size() && sides_[index].in_use && sides_[index].owner == owner_;
    }
    [[nodiscard]] bool is_node_in_use(std::uint32_t index) const noexcept
    {
        return index < nodes_.size() && nodes_[index].in_use && nodes_[index].owner == owner_;
    }
    /// Prefetches a node or a block into the cache.
    void prefetch(TreeRef ref) const noexcept
    {
        const void* first = ref.is_block() ? static_cast<const void*>(&blocks_[ref.index()])
                                           : static_cast<const void*>(&nodes_[ref.index()]);
        for (std::size_t line = 0; line < 4; ++line)
        {
            __builtin_prefetch(static_cast<const std::byte*>(first) + 64 * line);
        }
        if (ref.is_block())
        {
            __builtin_prefetch(&sides_[ref.index()].coarse);
        }
    }
    /// Box of all faces, errors added; empty if the tree is empty.
    [[nodiscard]] Aabb box() const noexcept TACTUS_NONBLOCKING;
    /// Box of a node or block of this tree, errors added.
    [[nodiscard]] Aabb box_of(TreeRef ref) const noexcept TACTUS_NONBLOCKING;
    /// Lasting id of a prim's face, used to break ties and in answers; none if the prim has no
    /// face.
    [[nodiscard]] FaceId face_of(PrimId prim) const noexcept
    {
        TACTUS_ASSERT(prim.value < prims_.size());
        return prims_[prim.value].face;
    }
    /// Place of a prim's face, block x 16 + lane; kNoLeaf if there is no face or it is unplaced.
    static constexpr std::uint32_t kNoLeaf = TreePrim::kNoLeaf;
    [[nodiscard]] std::uint32_t leaf_of(PrimId prim) const noexcept
    {
        const std::uint32_t leaf = prims_[prim.value].leaf;
        return (leaf & kUnplaced) != 0 ? kNoLeaf : leaf;
    }
    [[nodiscard]] NodeStatus status(TreeRef ref) const noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] std::uint32_t blocks_used() const noexcept { return blocks_used_; }
    [[nodiscard]] std::uint32_t blocks_used_max() const noexcept { return blocks_used_max_; }
    [[nodiscard]] std::uint32_t nodes_used() const noexcept { return nodes_used_; }
    [[nodiscard]] std::uint32_t nodes_used_max() const noexcept { return nodes_used_max_; }
    [[nodiscard]] const TreePool& pool() const noexcept { return *pool_; }
    [[nodiscard]] float quantum_m() const noexcept { return quantum_m_; }
    [[nodiscard]] const Kernels& kernels() const noexcept { return *kernels_; }

private:
    friend class TreeValidator;

    using Prim = TreePrim;
    static constexpr std::uint32_t kUnplaced = 0x8000'0000U;
    static constexpr std::uint32_t kLastUnplaced = 0x7FFF'FFFEU;

    [[nodiscard]] static std::uint64_t path_of(FaceId face,
                                               std::uint32_t bucket) noexcept TACTUS_NONBLOCKING;

    void place(const ChangedFace& face) noexcept;
    void insert_below(TreeRef ref, const ChangedFace& face, std::uint64_t path) noexcept;
    void insert_beside(std::uint32_t node, const ChangedFace& face, std::uint64_t path) noexcept;
    void insert_at_free_digit(std::uint32_t node, const ChangedFace& face,
                              std::uint32_t digit) noexcept;
    void insert_into_block(std::uint32_t block, const ChangedFace& face) noexcept;
    void update(const ChangedFace& face) noexcept;
    void reinsert(std::uint32_t block, const ChangedFace& face) noexcept;
    void take_out(PrimId prim) noexcept;
    void drop_empty(std::uint32_t block) noexcept;
    [[nodiscard]] bool has_reserve() const noexcept
    {
        return pool_->has_room_for(share_, kReserve);
    }

    [[nodiscard]] bool try_add(std::uint32_t block, const ChangedFace& face) noexcept;
    void split_block(std::uint32_t block, const ChangedFace& face) noexcept;
    [[nodiscard]] std::uint32_t part(std::uint32_t block, std::uint32_t bit, std::uint64_t path,
                                     std::uint32_t apart) noexcept;
    [[nodiscard]] std::uint32_t node_above(std::uint32_t block, std::uint32_t shift,
                                           std::uint64_t path) noexcept;
    void merge_upward(std::uint32_t block) noexcept;
    [[nodiscard]] bool try_absorb(std::uint32_t block, std::uint32_t other) noexcept;
    void hoist_only_child(std::uint32_t node) noexcept;

    void attach(std::uint32_t node, DigitRange digits, TreeRef ref) noexcept;
    void detach(std::uint32_t node, std::uint32_t child) noexcept;
    void replace(TreeRef old_ref, TreeRef new_ref) noexcept;
    void set_link(TreeRef ref, std::uint32_t parent, std::uint32_t child) noexcept;
    [[nodiscard]] ChangedFace describe(std::uint32_t block, std::uint32_t lane) const noexcept;

    [[nodiscard]] std::uint32_t take_block() noexcept;
    [[nodiscard]] std::uint32_t take_node(std::uint32_t shift, std::uint64_t prefix) noexcept;
    void free_block(std::uint32_t block) noexcept;
    void free_node(std::uint32_t node) noexcept;
    void give_back_freed() noexcept TACTUS_NONBLOCKING;
    void mark(TreeRef ref) noexcept;
    void enqueue(std::uint32_t index) noexcept;
    [[nodiscard]] Aabb refitted_box(std::uint32_t index) noexcept;
    void pass_up(std::uint32_t parent, std::uint32_t child, const Aabb& box,
                 FacesBelow faces) noexcept;
    void keep_unplaced(PrimId prim) noexcept;
    void drop_unplaced(PrimId prim) noexcept;

    TreePool* pool_;
    float quantum_m_;
    const Kernels* kernels_;
    std::span<BlockGeometry> blocks_; ///< Arrays of the whole pool, here and in the three below.
    std::span<BlockSide> sides_;
    std::span<AbNode> nodes_;
    std::span<Prim> prims_;
    std::array<std::uint32_t, kTreeLevels> dirty_heads_{};
    TreeRef root_;
    std::uint64_t last_change_{0};
    std::uint8_t owner_;
    TreeShare share_; ///< Use of the pool, with freed blocks and nodes that wait for refit.
    std::uint32_t marked_block_{kNoNode}; ///< First block that waits for refit; kNoNode: none.
    std::uint32_t marked_node_{kNoNode};
    std::uint32_t first_unplaced_{kLastUnplaced};
    std::uint32_t blocks_used_{0};
    std::uint32_t nodes_used_{0};
    std::uint32_t blocks_used_max_{0};
    std::uint32_t nodes_used_max_{0};
};

} // namespace tactus
