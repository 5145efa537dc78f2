// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// Any thread except the haptic one: strings allocate.
namespace tactus
{

/// Range of one number of an option's value.
struct NumberRange
{
    double least;
    double most;
    std::string_view unit{}; ///< Unit of the number; empty: none.
    bool may_be_zero{false}; ///< True if 0 is allowed in addition to the range.
};

/// Form of an option's value that consists of numbers separated by commas.
struct NumberForm
{
    /// Names of the numbers, separated by commas; optional ones in brackets. A leading word and
    /// colon are literal: "box:X,Y,Z[,R]".
    std::string_view text;
    std::span<const NumberRange> ranges; ///< Ranges, one for each name.
};

/// Reads the numbers of `value`, which begins with the form's word and colon. The refusal names the
/// first fault and the probably intended value, if any: "'sphere:2mm' is not sphere:R: R is in m,
/// without a unit; sphere:0.002?"
[[nodiscard]] Result<std::vector<double>, Refusal> read_numbers(std::string_view value,
                                                                const NumberForm& form);

/// Refusal in the words of read_numbers(), for a value that does not have the form. `meant` is the
/// intended value; empty if unknown.
[[nodiscard]] Refusal not_of_form(std::string_view value, std::string_view form,
                                  std::string_view fault, std::string_view meant = {});

/// Fault of one number, for example "R is 5, not in 1e-05 .. 1 m"; empty if `text` is in range.
[[nodiscard]] std::string fault_of_number(std::string_view name, std::string_view text,
                                          const NumberRange& range);

/// Finite number that the whole `text` represents; none for any other text.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

/// Number and noun: "1 brake", "2 brakes". If `many` is empty, the plural is `one` with an s.
[[nodiscard]] inline std::string counted(std::uint64_t number, std::string_view one,
                                         std::string_view many = {})
{
    const std::string plural = many.empty() ? std::string(one) + "s" : std::string(many);
    return std::to_string(number) + " " + (number == 1 ? std::string(one) : plural);
}

} // namespace tactus
