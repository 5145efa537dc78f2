// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"

#include <algorithm>
#include <cstdint>

namespace tactus
{

/// Time until a tool may touch an object, in classes. A frame serves pairs of tools and objects in
/// this order if it can't serve all.
enum class UrgencyClass : std::uint8_t
{
    touching, ///< Contact, possible within kTouching_s or not disproved yet.
    soon,     ///< Contact possible within kSoon_s.
    later,    ///< All others, and query-only tools that arrive soon.
    last,     ///< Query-only tools that arrive later.
};
inline constexpr std::uint32_t kUrgencyClasses = 4;
static_assert(static_cast<std::uint32_t>(UrgencyClass::last) + 1 == kUrgencyClasses);

struct Urgency
{
    /// A contact takes ten frames of splits and one or two loads.
    static constexpr double kSoon_s = 0.05;
    static constexpr double kTouching_s = 0.001;
    /// A device at rest may reach this speed at any moment.
    static constexpr double kLeastSpeed_m_per_s = 0.02;

    UrgencyClass of{UrgencyClass::touching};
    bool passes_through{false}; ///< Query-only tool: behind other pairs of its class, too.
    double contact_s{0.0};      ///< Time until the tool may touch the object.

    /// Urgency of a tool that is proven to be free for `gap_m` and whose device approaches at
    /// `speed_m_per_s`. A query-only tool has no force to lose and is one class later.
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
