// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_inspect/zone_option.hpp"

#include "transport/base/number_form.hpp"
#include "transport/base/printable.hpp"

#include <fmt/format.h>

#include <vector>

namespace tactus
{

namespace
{

constexpr NumberRange kAlong{-kMaxZoneCoordinate_m, kMaxZoneCoordinate_m, "m"};
constexpr NumberRange kOfSphere[] = {
    kAlong, kAlong, kAlong, {kMinZoneRadius_m, kMaxZoneCoordinate_m, "m"}};
constexpr NumberRange kOfBox[] = {kAlong, kAlong, kAlong, kAlong, kAlong, kAlong};
constexpr NumberForm kSphere{"sphere:x,y,z,r", kOfSphere};
constexpr NumberForm kBox{"box:x0,y0,z0,x1,y1,z1", kOfBox};

Result<Zone, Refusal> parse_sphere(std::string_view text)
{
    const auto numbers = read_numbers(text, kSphere);
    if (!numbers)
    {
        return numbers.error();
    }
    const std::vector<double>& n = numbers.value();
    return Zone{SphereZone{{n[0], n[1], n[2]}, n[3]}};
}

Result<Zone, Refusal> parse_box(std::string_view text)
{
    const auto numbers = read_numbers(text, kBox);
    if (!numbers)
    {
        return numbers.error();
    }
    const std::vector<double>& n = numbers.value();
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        if (n[3 + axis] < n[axis])
        {
            return not_of_form(
                text, kBox.text,
                fmt::format("{0}1 is {1}, less than {0}0, {2}", "xyz"[axis], n[3 + axis], n[axis]));
        }
    }
    return Zone{BoxZone{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}}};
}

} // namespace

Result<Zone, Refusal> parse_zone(std::string_view text)
{
    if (text.starts_with("sphere:"))
    {
        return parse_sphere(text);
    }
    if (text.starts_with("box:"))
    {
        return parse_box(text);
    }
    return Refusal{
        fmt::format("'{}' is neither {} nor {}", printable(text), kSphere.text, kBox.text)};
}

} // namespace tactus
