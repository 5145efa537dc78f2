// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/block.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/kernels/kernels.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/query/face_pair_queue.hpp"
#include "rt_core/query/pair_walk.hpp"
#include "rt_core/query/placed_blocks.hpp"
#include "rt_core/spm/error_code.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>

namespace tactus
{

class AbTree;
class OtherSurface;
struct UnfinishedSearch;

/// Faces that are in no tree yet, as lanes of a separate block.
struct LooseFaces
{
    const BlockGeometry& geometry;
    std::uint32_t lanes{0};                     ///< Lanes in use, one bit each; at least one.
    std::array<double, kBlockFaces> errors_m{}; ///< Errors of the faces in these lanes, in metres.
};

/// Search for a model's active coarse faces near another surface whose errors exceed a tolerance,
/// with lower bounds on their distances, from which both errors are subtracted. Lengths are in the
/// model's own frame.
///
/// Pairs of boxes are walked as in a query, but only in parts of the model with a coarse face: near
/// a refined surface there is little to test. Both trees must be refitted (AbTree::refit). Haptic
/// thread. Valid for one search. 50 KiB.
class NearFaces // NOLINT(cppcoreguidelines-pro-type-member-init): distances_ are written first.
{
public:
    /// Coarse faces of one block that may be within the bound.
    struct Block
    {
        std::uint32_t index{kNoNode}; ///< Block of the AB-Tree; kNoNode: faces without one.
        std::uint32_t lanes{0};
        /// Gaps of these lanes, in quanta of the other model.
        std::array<float, kBlockFaces> gaps{};
    };

    /// `other` is the other surface as seen from the model; its budget bounds the work. Faces with
    /// errors up to `tolerance` are not searched.
    NearFaces(const AbTree& own, OtherSurface& other,
              ErrorCode tolerance) noexcept TACTUS_NONBLOCKING;

    static constexpr std::uint32_t kAll = std::numeric_limits<std::uint32_t>::max();

    /// Finds coarse faces of the model within `bound_m` of the other surface: all, or until
    /// `enough` are found. With `unfinished` the search continues from there without finding the
    /// same faces again, and stores its rest if the budget is spent. Null: it begins at the roots
    /// and stores nothing.
    void find(double bound_m, std::uint32_t enough = kAll,
              UnfinishedSearch* unfinished = nullptr) noexcept TACTUS_NONBLOCKING;
    /// Finds near faces among `faces`, which a split would add to the model.
    void find(const LooseFaces& faces, double bound_m) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] std::span<const Block> blocks() const noexcept { return blocks_.view(); }
    [[nodiscard]] double gap_m(const Block& block, std::uint32_t lane) const noexcept
    {
        TACTUS_ASSERT((block.lanes >> lane & 1U) != 0);
        return to_m(block.gaps[lane]);
    }
    /// Lower bound on the distance of coarse faces in no block of blocks(), unless they are beyond
    /// the bound; infinite if everything was tested. The search ends early if no further block fits
    /// and a remaining face may meet the other surface.
    [[nodiscard]] double rest_m() const noexcept { return to_m(rest_); }

private:
    void search(double bound_m, const PairWalk::Start& start, const LooseFaces* loose,
                UnfinishedSearch* unfinished) noexcept;
    void resume(UnfinishedSearch& unfinished, PairWalk& walk) noexcept;
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
    /// Factor from a length in the own frame, in metres, to quanta of the other model.
    double quanta_per_m_;
    float bound_{0.0F};
    float rest_{kNothingLeft};
    std::uint32_t enough_{kAll};
    std::uint32_t found_{0}; ///< Number of faces found.
    FacePairQueue queue_;
    std::array<float, kPairLanes> errors_; ///< Sum of both faces' errors for each queued pair.
    PairDistances distances_;              ///< Bounds on the distances of the queued pairs.
    StaticVector<Block, kMaxNearBlocks> blocks_;
    std::uint32_t last_{0}; ///< Index in blocks_ of the block that was looked up last.
};

} // namespace tactus
