// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_inspect/zone_option.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

namespace tactus
{

namespace
{

constexpr std::string_view kBall = "sphere:";
constexpr std::string_view kBox = "box:";

Refusal error_in(std::string_view text, const std::string& reason)
{
    return {fmt::format("'{}': {}", text, reason)};
}

/// The whole of `text` as a finite number.
std::optional<double> parse_number(std::string_view text)
{
    double number = 0.0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    return error == std::errc() && stop == end && std::isfinite(number) ? std::optional(number)
                                                                        : std::nullopt;
}

/// Exactly `count` numbers within the range of coordinates, separated by commas.
Result<std::vector<double>, Refusal> parse_numbers(std::string_view text, std::size_t prefix,
                                                   std::size_t count)
{
    std::vector<double> numbers;
    for (std::size_t begin = prefix; begin <= text.size();)
    {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::string_view part = text.substr(begin, end - begin);
        const std::optional<double> number = parse_number(part);
        if (!number || std::abs(*number) > kMaxZoneCoordinate_m)
        {
            return error_in(text, fmt::format("'{}' is not a number in {} .. {}", part,
                                              -kMaxZoneCoordinate_m, kMaxZoneCoordinate_m));
        }
        numbers.push_back(*number);
        begin = end + 1;
    }
    if (numbers.size() != count)
    {
        return error_in(text, fmt::format("has {} numbers and needs {}", numbers.size(), count));
    }
    return numbers;
}

Result<Zone, Refusal> parse_ball(std::string_view text)
{
    const auto numbers = parse_numbers(text, kBall.size(), 4);
    if (!numbers)
    {
        return numbers.error();
    }
    const std::vector<double>& n = numbers.value();
    if (n[3] < kMinZoneRadius_m)
    {
        return error_in(text, fmt::format("radius {} is not in {} .. {}", n[3], kMinZoneRadius_m,
                                          kMaxZoneCoordinate_m));
    }
    return Zone{BallZone{{n[0], n[1], n[2]}, n[3]}};
}

Result<Zone, Refusal> parse_box(std::string_view text)
{
    const auto numbers = parse_numbers(text, kBox.size(), 6);
    if (!numbers)
    {
        return numbers.error();
    }
    const std::vector<double>& n = numbers.value();
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        if (n[3 + axis] < n[axis])
        {
            return error_in(text,
                            fmt::format("{0}1 = {1} is not in {0}0 .. {3}, {0}0 being {2}",
                                        "xyz"[axis], n[3 + axis], n[axis], kMaxZoneCoordinate_m));
        }
    }
    return Zone{BoxZone{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}}};
}

} // namespace

Result<Zone, Refusal> parse_zone(std::string_view text)
{
    if (text.substr(0, kBall.size()) == kBall)
    {
        return parse_ball(text);
    }
    if (text.substr(0, kBox.size()) == kBox)
    {
        return parse_box(text);
    }
    return error_in(text, "is neither sphere:x,y,z,r nor box:x0,y0,z0,x1,y1,z1");
}

} // namespace tactus
