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
enum class PriorityClass : std::uint8_t
{
    touching, ///< Contact possible within kTouching_s, or not disproved yet.
    soon,     ///< Contact possible within kSoon_s.
    later,    ///< Contact possible later; a query-only tool may arrive within kSoon_s.
    last,     ///< Query-only tools without possible contact within kSoon_s.
};
inline constexpr std::uint32_t kPriorityClasses = 4;
static_assert(static_cast<std::uint32_t>(PriorityClass::last) + 1 == kPriorityClasses);

/// Priority of a pair: its class, then tools with a force, then the time to contact.
struct Priority
{
    /// Time limit of PriorityClass::soon: a contact takes ten frames of splits and one or two
    /// loads.
    static constexpr double kSoon_s = 0.05;
    static constexpr double kTouching_s = 0.001;
    /// Least approach speed that counts: a device at rest may reach it at any moment.
    static constexpr double kLeastSpeed_m_per_s = 0.02;

    PriorityClass of{PriorityClass::touching};
    /// True for a query-only tool, which comes after other tools of its class.
    bool query_only{false};
    double contact_s{0.0}; ///< Time until the tool may touch the object.

    /// Priority of a pair with `gap_m` of proven free distance, >= 0 (asserted), whose device
    /// approaches at `speed_m_per_s`. A query-only tool has no force to lose and is one class
    /// later.
    [[nodiscard]] static Priority at(double gap_m, double speed_m_per_s, bool query_only) noexcept
    {
        TACTUS_ASSERT(gap_m >= 0.0);
        Priority priority;
        priority.query_only = query_only;
        priority.contact_s = gap_m / std::max(speed_m_per_s, kLeastSpeed_m_per_s);
        const auto place = (priority.contact_s <= kTouching_s ? 0
                            : priority.contact_s <= kSoon_s   ? 1
                                                              : 2) +
                           (query_only ? 1 : 0);
        priority.of = static_cast<PriorityClass>(place);
        return priority;
    }

    constexpr bool operator==(const Priority&) const noexcept = default;
    /// True if `a` has the higher priority.
    [[nodiscard]] friend constexpr bool operator<(const Priority& a, const Priority& b) noexcept
    {
        if (a.of != b.of || a.query_only != b.query_only)
        {
            return a.of != b.of ? a.of < b.of : b.query_only;
        }
        return a.contact_s < b.contact_s;
    }
};

} // namespace tactus
