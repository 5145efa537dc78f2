// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/query/face_pair_queue.hpp"
#include "rt_core/query/pair_walk.hpp"
#include "rt_core/query/placed_blocks.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <span>

namespace tactus
{

/// Faces that are in no tree yet: lanes of a block by itself.
struct LooseFaces
{
    const BlockGeometry& geometry;
    std::uint32_t lanes{0};                     ///< Those that are meant; at least one,
    std::array<double, kBlockFaces> errors_m{}; ///< and their errors.
};

/// What a search that its budget cut had not come to, for the next one of the same two models. What
/// it has proven holds for the boxes as they were: where a tree has changed since, it is of no use.
/// 4 KiB.
struct UnfinishedSearch
{
    PairWalk::LeftPairs left; ///< Empty: there is nothing to go on with.
    std::uint64_t own_change{0};
    std::uint64_t other_change{0};
    double bound_m{0.0};   ///< What was looked at is not nearer than this,
    double nearest_m{0.0}; ///< or, where something was found, than this.
    double moved_m{0.0};   ///< The other surface, since.
};

/// How far coarse faces of a model are from another surface: lower bounds on the distances of
/// active faces, both errors taken off. Lengths are of the model's own frame.
///
/// Pairs of boxes are walked as in a query, but of the model only where something is coarse: near a
/// surface that is refined there is little to look at. The boxes of both must be right
/// (AbTree::refit). Haptic thread; good for one search. 50 KiB.
class NearFaces // NOLINT(cppcoreguidelines-pro-type-member-init): distances_ are written first.
{
public:
    /// Coarse faces of one block that may be within the bound.
    struct Block
    {
        std::uint32_t index{kNoNode}; ///< Of loose faces there is none.
        std::uint32_t lanes{0};
        std::array<float, kBlockFaces> gaps{}; ///< Of these lanes, in quanta of the other.
    };

    /// `other` is the surface as the model sees it; its budget bounds the work.
    NearFaces(const AbTree& own, OtherSurface& other) noexcept TACTUS_NONBLOCKING;

    static constexpr std::uint32_t kAll = std::numeric_limits<std::uint32_t>::max();

    /// Looks for faces of the model within `bound_m`: all, or until `enough` were found. Goes on
    /// with an unfinished search, of which those that it found are not found again, and leaves one
    /// where the budget is spent; null: begins, and leaves nothing.
    void find(double bound_m, std::uint32_t enough = kAll,
              UnfinishedSearch* unfinished = nullptr) noexcept TACTUS_NONBLOCKING;
    /// The same of faces that will be the model's.
    void find(const LooseFaces& faces, double bound_m) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] std::span<const Block> blocks() const noexcept { return blocks_.view(); }
    [[nodiscard]] double gap_m(const Block& block, std::uint32_t lane) const noexcept
    {
        TACTUS_ASSERT((block.lanes >> lane & 1U) != 0);
        return to_m(block.gaps[lane]);
    }
    /// All that is coarse and in no block is beyond the bound, or no nearer than this: infinity
    /// when everything was looked at. The search ends where there is no room for a block more and
    /// something that is left may meet the other surface: it would tell nothing.
    [[nodiscard]] double rest_m() const noexcept { return to_m(rest_); }

private:
    void search(double bound_m, const PairWalk::Start& start, const LooseFaces* loose,
                UnfinishedSearch* unfinished) noexcept;
    void go_on(UnfinishedSearch& unfinished, PairWalk& walk) noexcept;
    void keep(const PairWalk& walk, bool is_done, UnfinishedSearch& unfinished) const noexcept;
    [[nodiscard]] bool is_full() const noexcept
    {
        return found_ >= enough_ || (blocks_.full() && !(rest_ > 0.0F));
    }
    [[nodiscard]] bool try_test(const PairWalk::Item& item, const PlacedBlock& own,
                                std::uint32_t lanes) noexcept;
    [[nodiscard]] std::uint32_t open_lanes(const PlacedBlock& own) noexcept;
    [[nodiscard]] bool may_meet(std::uint32_t block, std::uint32_t lane) noexcept;
    void measure() noexcept;
    void take(const FacePair& pair, float lower) noexcept;
    [[nodiscard]] Block* find_block(std::uint32_t index) noexcept;
    void leave(float gap) noexcept { rest_ = std::min(rest_, gap); }
    [[nodiscard]] double to_m(float quanta) const noexcept;

    static constexpr float kNothingLeft = std::numeric_limits<float>::infinity();

    const AbTree& own_;
    OtherSurface& other_;
    MeshViews views_;
    PlacedBlocks placed_;
    double quanta_per_m_; ///< Of the other, a length in the own frame.
    float bound_{0.0F};
    float rest_{kNothingLeft};
    std::uint32_t enough_{kAll};
    std::uint32_t found_{0}; ///< Faces.
    FacePairQueue queue_;
    std::array<float, kPairLanes> errors_; ///< Of the queue, of both faces together.
    PairDistances distances_;              ///< Of the queue.
    StaticVector<Block, kMaxNearBlocks> blocks_;
    std::uint32_t last_{0}; ///< The block that was looked up last.
};

} // namespace tactus
