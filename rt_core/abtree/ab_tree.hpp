// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/block.hpp"
#include "rt_core/abtree/node.hpp"
#include "rt_core/base/arena.hpp"
#include "rt_core/records/changed_face.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tactus
{

/// The paper's three words for a node: *inactive* nodes are not in the tree, *deformed* ones wait
/// for refit.
enum class NodeStatus : std::uint8_t
{
    inactive,
    active,
    deformed,
};

/// The Active Bounding Tree over one model's active faces.
///
/// It is a path-compressed radix tree. A face's path is its bucket (the upper bits of its rank in
/// the left-full median order of the finest mesh's faces) followed by its id with the bits mixed,
/// so paths differ and depend on nothing but the face. Leaves are blocks: the largest binary cells
/// of the path space that hold at most 16 active faces over at most 16 vertices. Binary levels
/// are collapsed into 8-wide nodes. Nodes and blocks exist only where faces are active.
///
/// Changes are applied face by face; boxes are right again after refit(), which visits deformed
/// blocks and nodes only, level by level from below, and stops where a box did not change. A box
/// holds its faces inflated by their error bounds, so a face's distance minus its error is never
/// less than the distance of any box around it.
///
/// When a pool is full a face stays *unplaced*: the tree is then incomplete() and a query may prove
/// nothing; unplaced faces are offered again by the caller in later frames.
///
/// Haptic thread only.
class AbTree
{
public:
    struct Capacities
    {
        std::uint32_t prims{0};
        std::uint32_t blocks{0};
        std::uint32_t nodes{0};
    };
    struct RefitWork
    {
        std::uint32_t blocks{0};
        std::uint32_t nodes{0};
    };

    AbTree(Arena& arena, const Capacities& capacities, float quantum_m) noexcept;

    /// Takes over one face as it is now: new, changed, or (face none) gone.
    void apply(const ChangedFace& change) noexcept;

    /// Makes all boxes right again. At most one visit for each dirty block and for each node on a
    /// path from one to the root.
    RefitWork refit() noexcept;

    [[nodiscard]] bool is_complete() const noexcept { return unplaced_count_ == 0; }
    [[nodiscard]] std::span<const PrimId> unplaced() const noexcept
    {
        return unplaced_.first(unplaced_count_);
    }
    /// Blocks and nodes that one more changed face may need at worst.
    static constexpr std::uint32_t kReserve = kBlockFaces + 1;
    [[nodiscard]] bool has_room_for(std::uint32_t changed_faces) const noexcept;

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
    /// The face that a prim stands for; its lasting name, used for ties and answers.
    [[nodiscard]] FaceId face_of(PrimId prim) const noexcept { return prims_[prim.value].face; }
    /// Block x 16 + lane of a prim, or kNoLeaf. With `parent` of blocks and nodes: the way up.
    static constexpr std::uint32_t kNoLeaf = 0xFFFF'FFFFU;
    [[nodiscard]] std::uint32_t leaf_of(PrimId prim) const noexcept
    {
        return prims_[prim.value].leaf;
    }
    [[nodiscard]] NodeStatus status(TreeRef ref) const noexcept;

    [[nodiscard]] std::uint32_t blocks_used() const noexcept { return blocks_used_; }
    [[nodiscard]] std::uint32_t blocks_used_max() const noexcept { return blocks_used_max_; }
    [[nodiscard]] std::uint32_t nodes_used() const noexcept { return nodes_used_; }
    [[nodiscard]] std::uint32_t nodes_used_max() const noexcept { return nodes_used_max_; }
    [[nodiscard]] const Capacities& capacities() const noexcept { return capacities_; }
    [[nodiscard]] float quantum_m() const noexcept { return quantum_m_; }

private:
    struct Prim
    {
        FaceId face{};
        std::uint32_t bucket{0};
        std::uint32_t leaf{kNoLeaf};
    };
    struct Keyed
    {
        std::uint64_t path{0};
        ChangedFace face;
    };
    /// A run of sorted faces that belongs into `width` digit values of a node, or at the root.
    struct Cell
    {
        std::uint32_t begin{0};
        std::uint32_t end{0};
        std::uint32_t parent{kNoNode};
        std::uint32_t width{kNodeChildren};
    };

    [[nodiscard]] static std::uint64_t path_of(FaceId face, std::uint32_t bucket) noexcept;

    void insert(const ChangedFace& face) noexcept;
    void insert_below(TreeRef ref, const ChangedFace& face, std::uint64_t path) noexcept;
    void insert_beside(std::uint32_t node, const ChangedFace& face, std::uint64_t path) noexcept;
    void insert_at_free_digit(std::uint32_t node, const ChangedFace& face,
                              std::uint32_t digit) noexcept;
    void insert_into_block(std::uint32_t block, const ChangedFace& face) noexcept;
    void update(const ChangedFace& face) noexcept;
    void remove(PrimId prim) noexcept;

    [[nodiscard]] bool try_add(std::uint32_t block, const ChangedFace& face) noexcept;
    void split_block(std::uint32_t block, const ChangedFace& face) noexcept;
    void distribute(std::span<const Keyed> faces, Cell first) noexcept;
    [[nodiscard]] bool try_build_block(std::span<const Keyed> faces, const Cell& cell) noexcept;
    void merge_upward(std::uint32_t block) noexcept;
    [[nodiscard]] bool try_absorb(std::uint32_t block, std::uint32_t other) noexcept;
    void hoist_only_child(std::uint32_t node) noexcept;

    void attach(std::uint32_t node, DigitRange digits, TreeRef ref) noexcept;
    void detach(std::uint32_t node, std::uint32_t child) noexcept;
    void replace(TreeRef old_ref, TreeRef new_ref) noexcept;
    void set_link(TreeRef ref, std::uint32_t parent, std::uint32_t child) noexcept;
    [[nodiscard]] ChangedFace face_in(std::uint32_t block, std::uint32_t lane) const noexcept;

    [[nodiscard]] std::uint32_t take_block() noexcept;
    [[nodiscard]] std::uint32_t take_node(std::uint32_t shift, std::uint64_t prefix) noexcept;
    void free_block(std::uint32_t block) noexcept;
    void free_node(std::uint32_t node) noexcept;
    void mark(TreeRef ref) noexcept;
    void enqueue(std::uint32_t index) noexcept;
    void pass_up(std::uint32_t parent, std::uint32_t child, const Aabb& box, bool coarse) noexcept;
    void keep_unplaced(PrimId prim) noexcept;
    void drop_unplaced(PrimId prim) noexcept;

    static constexpr std::uint32_t kLevels = 22; ///< Octal digits of a 64-bit path.

    Capacities capacities_;
    float quantum_m_;
    std::span<BlockGeometry> blocks_;
    std::span<BlockSide> sides_;
    std::span<AbNode> nodes_;
    std::span<Prim> prims_;
    std::span<std::uint32_t> free_blocks_;
    std::span<std::uint32_t> free_nodes_;
    std::span<PrimId> unplaced_;
    std::span<TreeRef> marked_;           ///< Blocks and nodes that wait for refit.
    std::span<std::uint8_t> block_marks_; ///< Whether a block is in `marked_`, even once freed.
    std::span<std::uint8_t> node_marks_;
    std::array<std::uint32_t, kLevels> dirty_heads_{};
    TreeRef root_;
    std::uint32_t free_block_count_{0};
    std::uint32_t free_node_count_{0};
    std::uint32_t unplaced_count_{0};
    std::uint32_t marked_count_{0};
    std::uint32_t blocks_used_{0};
    std::uint32_t blocks_used_max_{0};
    std::uint32_t nodes_used_{0};
    std::uint32_t nodes_used_max_{0};
};

} // namespace tactus
