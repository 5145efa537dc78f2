// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/force/placed_surface.hpp"

#include <cstdint>
#include <span>

namespace tactus
{

/// Object number that stands for no object.
inline constexpr std::uint32_t kNoObject = 0xFFFF'FFFFU;

/// Result of carried(): the place of a proxy after the objects near it have moved.
template <typename Place>
struct Carried
{
    Place place;
    /// Object that carried the proxy; null if the proxy stayed.
    const NearObject* by{nullptr};
    /// True if an object may have passed over the proxy, at every place tried.
    bool is_overrun{false};
};

/// Carries a proxy along with the object that holds it. If an object may then pass over the proxy,
/// tries the proxy's old place, and then to carry it along with each moved object.
///
/// `along(object)` is the place of a proxy carried by the object. `is_overrun(place)` is true if a
/// proxy moved to `place` may have changed the side of some surface. Haptic thread.
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
