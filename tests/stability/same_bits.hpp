// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/contact.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace tactus::test
{

[[nodiscard]] inline bool same_bits(double a, double b)
{
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

[[nodiscard]] inline bool same_bits(const Vec3& a, const Vec3& b)
{
    return same_bits(a.x(), b.x()) && same_bits(a.y(), b.y()) && same_bits(a.z(), b.z());
}

[[nodiscard]] inline bool same_bits(const Contact& a, const Contact& b)
{
    return a.face == b.face && a.tool_face == b.tool_face && a.feature == b.feature &&
           same_bits(a.distance_m, b.distance_m) && same_bits(a.on_tool_m, b.on_tool_m) &&
           same_bits(a.on_surface_m, b.on_surface_m) && same_bits(a.normal, b.normal);
}

[[nodiscard]] inline bool same_bits(const ContactSet& a, const ContactSet& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const Contact& x, const Contact& y) { return same_bits(x, y); });
}

} // namespace tactus::test
