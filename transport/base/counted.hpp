// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

// Any thread except the haptic one: strings allocate.
namespace tactus
{

/// Number and noun: "1 brake", "2 brakes". If `many` is empty, the plural is `one` with an s.
[[nodiscard]] inline std::string counted(std::uint64_t number, std::string_view one,
                                         std::string_view many = {})
{
    const std::string plural = many.empty() ? std::string(one) + "s" : std::string(many);
    return std::to_string(number) + " " + (number == 1 ? std::string(one) : plural);
}

} // namespace tactus
