// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/pair_shedding.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/frame/pair.hpp"

#include <algorithm>

namespace tactus
{

bool PairShedding::shed(std::span<Pair* const> order) noexcept
{
    const bool is_needed = !order.empty() && order[0]->priority().of <= below_;
    std::uint32_t left = is_needed ? count_ : 0;
    count_ = left;
    for (std::size_t i = order.size(); i > 0; --i)
    {
        Pair& pair = *order[i - 1];
        const bool is_shed = left > 0 && pair.is_awake() && pair.priority().of > below_;
        pair.shed(is_shed);
        left -= is_shed ? 1 : 0;
    }
    count_ -= left; // Fewer pairs were left to shed than counted.
    return count_ > 0;
}

void PairShedding::learn(std::uint32_t refused) noexcept
{
    TACTUS_ASSERT(refused <= kPriorityClasses);
    if (refused <= static_cast<std::uint32_t>(PriorityClass::soon))
    {
        const auto of = static_cast<PriorityClass>(refused);
        below_ = count_ > 0 ? std::min(below_, of) : of;
        ++count_;
        patience_ = has_come_back_ ? std::min(2 * patience_, kCalmFramesMost) : patience_;
        has_come_back_ = false;
        calm_frames_ = 0;
    }
    else if (++calm_frames_ >= patience_)
    {
        has_come_back_ = count_ > 0;
        patience_ = count_ > 0 ? patience_ : kCalmFrames;
        count_ -= count_ > 0 ? 1 : 0;
        calm_frames_ = 0;
    }
}

} // namespace tactus
