// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/node.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/kernels/kernels.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/aabb.hpp"
#include "rt_core/query/box_view.hpp"
#include "rt_core/query/mesh_placement.hpp"
#include "rt_core/query/pair_front.hpp"
#include "rt_core/spm/error_code.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tactus
{

class AbTree;
struct WalkBudget;

/// Views of two models' boxes in each other's frames. Lengths are in quanta of the object.
class MeshViews
{
public:
    MeshViews(const AbTree& tool, const AbTree& object,
              const MeshPlacement& place) noexcept TACTUS_NONBLOCKING;

    /// True if the tool is beyond the range of single precision; no other member may then be used.
    [[nodiscard]] bool is_beyond_kernels() const noexcept { return is_beyond_; }
    [[nodiscard]] const BoxView& of_tool() const noexcept { return of_tool_; }
    [[nodiscard]] const BoxView& of_object() const noexcept { return of_object_; }
    [[nodiscard]] double scale() const noexcept { return scale_; }
    /// Bound on the rounding of a coordinate by placement and single precision.
    [[nodiscard]] float slack() const noexcept { return slack_; }
    /// Upper bound on the distance of any placed coordinate from the object's origin.
    [[nodiscard]] double farthest() const noexcept { return farthest_; }

private:
    [[nodiscard]] float slack_of(const AbTree& tool, const AbTree& object,
                                 const MeshPlacement& place) noexcept;

    double scale_;
    double farthest_{0.0};
    bool is_beyond_{false};
    float slack_;
    BoxView of_tool_;
    BoxView of_object_;
};

/// Depth-first walk of the pairs of blocks of two trees that may be near each other. The larger box
/// of a pair is opened, and its eight children are measured against the other box at once. The
/// nearest pair is entered first. With a front the walk continues from the last one's end and opens
/// only pairs that have come near since. Haptic thread. Takes about 50 ns for each opened node, 3
/// ns for each unchanged pair. 25 KiB.
class PairWalk
{
public:
    struct Item
    {
        TreeRef tool;
        TreeRef object;
        Aabb tool_box; ///< Box in the tool's frame.
        Aabb object_box;
        float gap{0.0F}; ///< Lower bound on the boxes' distance, less their errors.
        std::uint8_t depth{0};
        std::uint8_t child{0}; ///< Index of the opened box in its node.
        /// Children with entries in the front, one bit each; `gap` is that of the other children.
        std::uint8_t entered{0};
    };

    /// Part of the tool at which a walk starts.
    struct Start
    {
        /// Root of the walk. A block's contents are not read, so it need not be in a tree.
        TreeRef tool;
        Aabb box;                ///< Box round the part, with errors added.
        bool coarse_only{false}; ///< True if exact subtrees are left out.
    };

    /// Parameters of the next step.
    struct Sought
    {
        /// Distance in quanta within which faces of two blocks matter. Must never grow.
        float bound{0.0F};
        /// Further direction to measure along, from the object to the tool, not longer than 1;
        /// null: none.
        const Vec3f* way{nullptr};
        /// True if open faces (coarse and above the tolerance) are left out. Once true, it stays
        /// true.
        bool leaves_open{false};
        /// Block of the tool for which the search is over; its pairs are skipped.
        TreeRef settled{};
    };

    /// Both trees must be refitted (AbTree::refit). `views` must not be beyond the kernels.
    PairWalk(const AbTree& tool, const AbTree& object, const MeshViews& views, WalkBudget& budget,
             const Start& start) noexcept TACTUS_NONBLOCKING;
    /// Faces that a walk of the whole tool visits, and the memory of the last such walk.
    struct Surfaces
    {
        const MeshPlacement& place; ///< Placement that the views were made with.
        PairFront* front{nullptr};  ///< Front of the same two trees; null: none.
        /// Largest errors of the tool's and the object's faces that count as the surface.
        ErrorCode tool_tolerance{0};
        ErrorCode tolerance{0};
        bool leaves_open{false}; ///< Value of Sought::leaves_open for the first step.
    };
    /// Walk of the whole tool.
    PairWalk(const AbTree& tool, const AbTree& object, const MeshViews& views, WalkBudget& budget,
             const Surfaces& surfaces) noexcept TACTUS_NONBLOCKING;

    /// Returns the next pair of blocks, valid until the next call; null if there is none or the
    /// budget is spent.
    [[nodiscard]] const Item* next_blocks(const Sought& sought) noexcept TACTUS_NONBLOCKING;
    /// Records a lower bound on the distance of the last pair of next_blocks(), less errors.
    void end_pair(float gap) noexcept TACTUS_NONBLOCKING;

    /// Pair that an earlier walk of the same boxes had not visited.
    struct Left
    {
        TreeRef tool;
        TreeRef object;
        float gap{0.0F};
    };
    static constexpr std::size_t kMostLeft = std::size_t{2} * kTreeStack;
    using LeftPairs = StaticVector<Left, kMostLeft>;
    /// Starts the walk with `pairs` instead of the roots; the pairs may have come nearer by
    /// `travel`.
    void resume(const LeftPairs& pairs, double travel) noexcept TACTUS_NONBLOCKING;
    /// Stores the unvisited pairs in `pairs`. `is_done` is false if the last pair of next_blocks()
    /// is among them.
    void keep_left(bool is_done, LeftPairs& pairs) const noexcept TACTUS_NONBLOCKING;

    /// Ends the walk at any point. Returns a lower bound on the distance of unvisited pairs;
    /// infinite after a complete walk.
    [[nodiscard]] float end() noexcept TACTUS_NONBLOCKING;

private:
    /// Box of the tool, placed in the object's frame.
    struct Seen // NOLINT(cppcoreguidelines-pro-type-member-init): a box comes with its ref.
    {
        TreeRef ref;
        KernelBox box;
    };
    static constexpr std::uint32_t kSeen = 16;
    static constexpr std::uint32_t kDepths = 2 * kTreeLevels + 2;

    [[nodiscard]] bool is_wanted(TreeRef tool) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool can_resume(const Surfaces& surfaces) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool try_step() noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool skip_dropped() noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] Item item_of(const PairFront::Entry& entry) const noexcept TACTUS_NONBLOCKING;
    void write(const PairFront::Entry& entry) noexcept TACTUS_NONBLOCKING;
    void keep(const Item& item) noexcept TACTUS_NONBLOCKING;
    void open(const Item& item, const Sought& sought) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool is_tool_larger(const Item& item) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] const KernelBox& seen(const Item& item) noexcept TACTUS_NONBLOCKING;

    const AbTree& tool_;
    const AbTree& object_;
    const MeshViews& views_;
    WalkBudget& budget_;
    bool coarse_only_; ///< True if exact subtrees of the tool are left out.
    /// True if a coarse face may count as the surface: subtrees without an exact face may matter.
    bool is_tolerant_{false};
    Item current_;
    /// Recently placed boxes of the tool, each at its reference modulo kSeen.
    std::array<Seen, kSeen> seen_;
    StaticVector<Item, kMostLeft> stack_;
    PairFront* front_{nullptr}; ///< Front that this walk keeps; null: none.
    // Entries of the last walk lie at the front's end and are read from there. Entries of this walk
    // are written from its beginning.
    std::uint32_t read_{PairFront::kRoom};
    std::uint32_t written_{0};
    /// True if the front is full: nothing more is written, and the next walk starts at the roots.
    bool has_overflowed_{false};
    float limit_{0.0F}; ///< Largest `until` of entries that are tested again.
    /// Children, one bit each, that the present walk dropped as far at each depth.
    std::array<std::uint8_t, kDepths> dropped_{};
};

} // namespace tactus
