// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

// Usable on any thread: plain values and pure functions. No call waits or allocates.
namespace tactus
{

/// Cost of one step of each kind, in instructions: callgrind's counts of frames on models of 69,000
/// and 1.1 million faces, AVX2, rounded up, including the work around the step.
struct WorkCost
{
    static constexpr std::uint32_t node = 200;       ///< Visit of a node or block by a walk.
    static constexpr std::uint32_t triangle = 90;    ///< Triangle against a tool's core.
    static constexpr std::uint32_t measured = 2'500; ///< Exact measurement of a triangle.
    /// Exact measurement at a corner over a box's side.
    static constexpr std::uint32_t at_corner = 1'100;
    static constexpr std::uint32_t gjk = 4'200;   ///< Exact measurement of a triangle from a hull.
    static constexpr std::uint32_t contact = 100; ///< Triangle in reach, for contacts.
    /// Two boxes of two meshes, of which one is opened.
    static constexpr std::uint32_t pair_node = 450;
    static constexpr std::uint32_t block_row = 100; ///< Face against another mesh's block.
    /// Face that may have to be split, against another mesh's block.
    static constexpr std::uint32_t coarse_row = 50;
    /// Block near a face that may have to be split.
    static constexpr std::uint32_t near_block = 600;
    static constexpr std::uint32_t face_pair = 400; ///< Two faces of two meshes.
    static constexpr std::uint32_t walk = 3'000;    ///< Start of a search of two meshes.
    static constexpr std::uint32_t split = 6'000;   ///< Split without its search and refit.
    /// Added to a split for each question of its request.
    static constexpr std::uint32_t question = 300;
    static constexpr std::uint32_t merge = 3'200;     ///< Merge without its refit.
    static constexpr std::uint32_t scan = 250;        ///< Record checked for merging.
    static constexpr std::uint32_t edited_face = 700; ///< Face of an edit without its refit.
    static constexpr std::uint32_t refit = 300;       ///< Refit of a block or node.
    static constexpr std::uint32_t index_group = 200; ///< Eight boxes of an index page.
    /// One sphere against eight boxes of an index page.
    static constexpr std::uint32_t index_sphere = 50;
    /// Search for a model's requests, without its index pages.
    static constexpr std::uint32_t search = 3'000;
    /// Choice of a face to split, without the walk to the face.
    static constexpr std::uint32_t refining = 4'000;
    static constexpr std::uint32_t plane = 1'300; ///< One check of Budgets::planes.
    /// One step of a rigid tool.
    static constexpr std::uint32_t rigid_step = 20'000;
};

/// Counter of a frame's work in instructions, with a limit. Each loop takes the cost of its next
/// step and stops if refused, so a frame exceeds its limit by at most one step of each kind. The
/// same inputs give the same work on every machine.
class WorkBudget
{
public:
    static constexpr std::uint32_t kUnlimited = std::numeric_limits<std::uint32_t>::max();
    /// Least work with which a frame makes progress: a page searched, a split, a query of a sphere
    /// and its force.
    static constexpr std::uint32_t kLeast = 80'000;

    WorkBudget() noexcept = default;
    explicit WorkBudget(std::uint32_t limit) noexcept : limit_(limit) {}

    /// Bound on the work of a frame with this limit, including the steps that exceed it.
    [[nodiscard]] static constexpr std::uint32_t most_of(std::uint32_t limit) noexcept
    {
        const std::uint64_t most = std::uint64_t{6} * std::max(limit, kLeast) / 5;
        return static_cast<std::uint32_t>(std::min<std::uint64_t>(most, kUnlimited));
    }

    /// Takes `cost`. False, with nothing taken, if the limit has been reached.
    [[nodiscard]] bool try_take(std::uint32_t cost) noexcept
    {
        if (is_spent())
        {
            return false;
        }
        spend(cost);
        return true;
    }
    /// Takes `cost` for work that is done in any case.
    void spend(std::uint32_t cost) noexcept { used_ += std::min(cost, kUnlimited - used_); }

    [[nodiscard]] bool is_spent() const noexcept { return used_ >= limit_; }
    [[nodiscard]] std::uint32_t used() const noexcept { return used_; }
    [[nodiscard]] std::uint32_t left() const noexcept { return limit_ - std::min(limit_, used_); }
    /// Sets the limit; work taken before still counts.
    void limit(std::uint32_t limit) noexcept { limit_ = limit; }

private:
    std::uint32_t used_{0};
    std::uint32_t limit_{kUnlimited};
};

} // namespace tactus
