// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/refine/work_pace.hpp"

#include "rt_core/base/assert.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

constexpr std::uint32_t kOne = 256;   ///< Unit of the mean: one split per frame.
constexpr std::uint32_t kFrames = 32; ///< Time constant of the mean.
constexpr std::uint32_t kBudgetMax = 1'000'000;

/// Upper limit: two fifths of the budget, but not below `least`.
std::uint32_t most_of(std::uint32_t budget, std::uint32_t least) noexcept
{
    TACTUS_ASSERT(budget <= kBudgetMax);
    return std::max(least, 2 * budget / 5);
}

/// One and a half times the mean, plus two.
std::uint32_t steady(std::uint32_t mean) noexcept
{
    return 3 * mean / (2 * kOne) + 2;
}

} // namespace

void WorkPace::count(std::uint32_t splits) noexcept
{
    TACTUS_ASSERT(splits <= kBudgetMax);
    last_ = splits;
    mean_ -= mean_ / kFrames;
    mean_ += splits * kOne / kFrames;
}

std::uint32_t WorkPace::splits_of(std::uint32_t budget) const noexcept
{
    const std::uint32_t least = (budget + 7) / 8;
    return std::clamp(steady(mean_), least, most_of(budget, least));
}

/// Limits the last frame's splits plus this frame's merges to nine eighths of twice the mean: in
/// the long run each split is merged.
std::uint32_t WorkPace::merges_of(std::uint32_t budget) const noexcept
{
    const std::uint32_t least = (budget + 15) / 16;
    const std::uint32_t both = 9 * mean_ / (4 * kOne) + 2;
    return std::clamp(std::min(steady(mean_), both - std::min(both, last_)), least,
                      most_of(budget, least));
}

} // namespace tactus
