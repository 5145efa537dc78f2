// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/work_shares.hpp"

#include "rt_core/base/assert.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

/// Shares of a frame's work that may be used by the end of each stage; kWarming is for warming
/// caches.
constexpr double kLoading = 0.3;
constexpr double kRefiningLeast = 0.25;
constexpr double kRefiningMost = 0.6;
constexpr double kQueries = 0.9;
constexpr double kWarming = 0.25;
/// Work reserved for queries and forces, as a multiple of that in the last frame.
constexpr double kMoreAnswers = 1.1;
/// Instructions reserved for each later query, if as much is left.
constexpr std::uint32_t kQueryKept = 20'000;
constexpr std::uint32_t kPlanesLeast = 16;

} // namespace

std::uint32_t WorkShares::part(double share) const noexcept
{
    return most_ == WorkBudget::kUnlimited ? most_ : static_cast<std::uint32_t>(share * most_);
}

void WorkShares::begin(std::uint32_t most, WorkBudget& work) noexcept
{
    most_ = std::max(most, WorkBudget::kLeast);
    work_ = &work;
}

void WorkShares::begin_loading() noexcept
{
    TACTUS_ASSERT(work_ != nullptr); // begin() comes first.
    work_->limit(part(kLoading));
}

void WorkShares::begin_refining() noexcept
{
    const double kept = kMoreAnswers * answers_ / most_;
    work_->limit(part(std::clamp(1.0 - kept, kRefiningLeast, kRefiningMost)));
}

void WorkShares::begin_queries() noexcept
{
    before_answers_ = work_->used();
    query_most_ = part(kQueries);
}

void WorkShares::begin_query(std::uint32_t later) noexcept
{
    const std::uint32_t left = query_most_ - std::min(query_most_, work_->used());
    work_->limit(query_most_ - later * std::min(kQueryKept, left / (later + 1)));
}

void WorkShares::begin_forces() noexcept
{
    work_->limit(most_);
}

void WorkShares::end() noexcept
{
    TACTUS_ASSERT(work_->used() >= before_answers_);
    answers_ = work_->used() - before_answers_;
}

std::uint32_t WorkShares::planes() const noexcept
{
    return std::max(kPlanesLeast, work_->left() / WorkCost::plane);
}

WorkBudget WorkShares::for_warming() const noexcept
{
    return WorkBudget(part(kWarming));
}

} // namespace tactus
