// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/force/near_object.hpp"

#include <cstdint>
#include <span>

namespace tactus
{

/// Number that no object has.
inline constexpr std::uint32_t kNoObject = 0xFFFF'FFFFU;

/// Place of a proxy after the objects near it have moved.
template <typename Place>
struct Carried
{
    Place place;
    /// The object that carried it; null if it stayed.
    const NearObject* by{nullptr};
    /// An object may have passed over it at any of the places tried.
    bool is_overrun{false};
};

/// Carries a proxy along with the object that holds it, or else with one that would pass over it,
/// so that it keeps its place before that object's surface. Otherwise the proxy stays. Reports
/// is_overrun if an object passes over it in each case.
///
/// `along(object)` is its place when carried by an object; `is_overrun(place)` is true if the proxy
/// may be on another side of some surface there. Haptic thread.
template <typename Place, typename Along, typename Overrun>
[[nodiscard]] Carried<Place> carried(const Place& stays, std::span<const NearObject> objects,
                                     std::uint32_t held_by, const Along& along,
                                     const Overrun& is_overrun) noexcept
{
    Carried<Place> target{stays};
    for (const NearObject& object : objects)
    {
        if (object.has_moved() && object.object == held_by)
        {
            target = {along(object), &object};
        }
    }
    if (!is_overrun(target.place))
    {
        return target;
    }
    if (!is_overrun(stays))
    {
        return {stays};
    }
    for (const NearObject& object : objects)
    {
        const Place place = object.has_moved() ? along(object) : stays;
        if (object.has_moved() && !is_overrun(place))
        {
            return {place, &object};
        }
    }
    target.is_overrun = true;
    return target;
}

} // namespace tactus
