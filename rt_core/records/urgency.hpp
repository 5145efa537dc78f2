// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"

#include <algorithm>
#include <cstdint>

namespace tactus
{

/// How soon a tool may touch an object. What a frame can't do for all pairs of tools and objects it
/// does in this order.
enum class UrgencyClass : std::uint8_t
{
    touching, ///< In touch, or within kTouching_s, or not known to be apart yet.
    soon,     ///< Within kSoon_s.
    later,    ///< The rest, and tools that pass through and will be there soon.
    last,     ///< Tools that pass through, later.
};
inline constexpr std::uint32_t kUrgencyClasses = 4;
static_assert(static_cast<std::uint32_t>(UrgencyClass::last) + 1 == kUrgencyClasses);

struct Urgency
{
    /// A contact takes ten frames of splits, and a load or two.
    static constexpr double kSoon_s = 0.05;
    static constexpr double kTouching_s = 0.001;
    /// A hand that rests may move at this speed the next moment.
    static constexpr double kLeastSpeed_m_per_s = 0.02;

    UrgencyClass of{UrgencyClass::touching};
    bool passes_through{false}; ///< Comes behind others of its class, too.
    double contact_s{0.0};      ///< Until the tool may touch the object.

    /// Of a tool that surfaces proven to be `gap_m` away can't hold back before; its hand comes at
    /// `speed_m_per_s`. One that passes through has no force to lose: it comes a class later.
    [[nodiscard]] static Urgency at(double gap_m, double speed_m_per_s,
                                    bool passes_through) noexcept
    {
        TACTUS_ASSERT(gap_m >= 0.0);
        Urgency urgency;
        urgency.passes_through = passes_through;
        urgency.contact_s = gap_m / std::max(speed_m_per_s, kLeastSpeed_m_per_s);
        const auto place = (urgency.contact_s <= kTouching_s ? 0
                            : urgency.contact_s <= kSoon_s   ? 1
                                                             : 2) +
                           (passes_through ? 1 : 0);
        urgency.of = static_cast<UrgencyClass>(place);
        return urgency;
    }

    constexpr bool operator==(const Urgency&) const noexcept = default;
    /// The more urgent one first.
    [[nodiscard]] friend constexpr bool operator<(const Urgency& a, const Urgency& b) noexcept
    {
        if (a.of != b.of || a.passes_through != b.passes_through)
        {
            return a.of != b.of ? a.of < b.of : b.passes_through;
        }
        return a.contact_s < b.contact_s;
    }
};

} // namespace tactus
