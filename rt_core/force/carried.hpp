// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/force/near_object.hpp"

#include <cstdint>
#include <span>

namespace tactus
{

/// The number of no object.
inline constexpr std::uint32_t kNoObject = 0xFFFF'FFFFU;

/// Where a proxy is when the objects near it have moved.
template <typename Place>
struct Carried
{
    Place place;
    const NearObject* by{nullptr}; ///< The object that it went along with; null where it stayed.
    bool is_overrun{false};        ///< Wherever it is, some object may have come over it.
};

/// A proxy goes along with the object that holds it, or else with one that would run over it, so
/// that it is before that one's surface as it was; where neither is called for it stays. Where some
/// object runs over it whatever it does, that is said.
///
/// `along(object)` is its place when it goes along with an object, `is_overrun(place)` whether it
/// may have come to another side of some surface when it is there. Haptic thread.
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
