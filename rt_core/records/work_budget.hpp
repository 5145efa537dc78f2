// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// The cost of one step of each kind, in instructions: callgrind's counts of frames on models of
/// 69,000 and 1.1 million faces, AVX2, rounded up, with what is done around the step.
struct WorkCost
{
    static constexpr std::uint32_t node = 200;        ///< A node or block that a walk visits.
    static constexpr std::uint32_t triangle = 90;     ///< A triangle before a tool's core.
    static constexpr std::uint32_t measured = 2'500;  ///< One that is measured exactly,
    static constexpr std::uint32_t gjk = 4'200;       ///< and from a hull.
    static constexpr std::uint32_t contact = 100;     ///< A triangle in reach, for contacts.
    static constexpr std::uint32_t pair_node = 450;   ///< Two boxes of two meshes, one opened.
    static constexpr std::uint32_t block_row = 100;   ///< A face before another mesh's block,
    static constexpr std::uint32_t coarse_row = 50;   ///< one that may have to be split,
    static constexpr std::uint32_t near_block = 600;  ///< and the block that such a face is near.
    static constexpr std::uint32_t face_pair = 400;   ///< Two faces of two meshes.
    static constexpr std::uint32_t walk = 3'000;      ///< The start of a search of two meshes.
    static constexpr std::uint32_t split = 6'000;     ///< A split, without its search and refit,
    static constexpr std::uint32_t question = 300;    ///< and each place it may matter to.
    static constexpr std::uint32_t merge = 3'200;     ///< A merge, without its refit.
    static constexpr std::uint32_t scan = 250;        ///< A record looked at for merging.
    static constexpr std::uint32_t refit = 300;       ///< A block or node refitted.
    static constexpr std::uint32_t index_group = 200; ///< Eight boxes of an index page,
    static constexpr std::uint32_t index_ball = 50;   ///< and one ball before them.
    static constexpr std::uint32_t search = 3'000;    ///< What a model asks for, besides those.
    static constexpr std::uint32_t refining = 4'000;  ///< What to split, besides the walk to it.
    static constexpr std::uint32_t plane = 1'300;     ///< Budgets::planes.
    /// A step of a tool that is held as a body.
    static constexpr std::uint32_t rigid_step = 20'000;
};

/// The work of a frame, in instructions, and how far it may go. Every loop draws on it and stops
/// where it refuses, so a frame exceeds its limit by no more than one step of each kind. Counts
/// alone: the same inputs give the same work on every machine.
class WorkBudget
{
public:
    static constexpr std::uint32_t kUnlimited = std::numeric_limits<std::uint32_t>::max();
    /// A frame needs so much to get on: a page searched, a split, a query of a ball and its force.
    static constexpr std::uint32_t kLeast = 80'000;

    WorkBudget() noexcept = default;
    explicit WorkBudget(std::uint32_t limit) noexcept : limit_(limit) {}

    /// The most that a frame with this limit comes to: it ends the step that it is in.
    [[nodiscard]] static constexpr std::uint32_t most_of(std::uint32_t limit) noexcept
    {
        const std::uint64_t most = std::uint64_t{6} * std::max(limit, kLeast) / 5;
        return static_cast<std::uint32_t>(std::min<std::uint64_t>(most, kUnlimited));
    }

    /// False, and nothing is taken, where the limit has been reached.
    [[nodiscard]] bool try_take(std::uint32_t cost) noexcept
    {
        if (is_spent())
        {
            return false;
        }
        spend(cost);
        return true;
    }
    /// What is done in any case.
    void spend(std::uint32_t cost) noexcept { used_ += std::min(cost, kUnlimited - used_); }

    [[nodiscard]] bool is_spent() const noexcept { return used_ >= limit_; }
    [[nodiscard]] std::uint32_t used() const noexcept { return used_; }
    [[nodiscard]] std::uint32_t left() const noexcept { return limit_ - std::min(limit_, used_); }
    /// From now on the work may go as far as this.
    void limit(std::uint32_t limit) noexcept { limit_ = limit; }

private:
    std::uint32_t used_{0};
    std::uint32_t limit_{kUnlimited};
};

} // namespace tactus
