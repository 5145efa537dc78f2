// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

// Any thread, except the haptic one: texts allocate.
namespace tactus
{

/// Range of one number of a value.
struct NumberRange
{
    double least;
    double most;
    std::string_view unit{}; ///< Unit; empty: the number has none.
    bool may_be_zero{false}; ///< True if 0 is allowed in addition to the range.
};

/// Form of an option's value that consists of numbers separated by commas.
struct NumberForm
{
    /// Names of the numbers, optional ones in brackets, after a leading word and colon if the form
    /// has one: "box:X,Y,Z[,R]".
    std::string_view text;
    std::span<const NumberRange> ranges; ///< Ranges, one for each name.
};

/// Reads `value`, which begins with the word and the colon of the form. The refusal names the first
/// fault and, if one is near, the intended value: "'sphere:2mm' is not sphere:R: R is in m, without
/// a unit; sphere:0.002?"
[[nodiscard]] Result<std::vector<double>, Refusal> read_numbers(std::string_view value,
                                                                const NumberForm& form);

/// Refusal of a value that lacks this form, worded like that of read_numbers(). `meant` may be
/// empty.
[[nodiscard]] Refusal not_of_form(std::string_view value, std::string_view form,
                                  std::string_view fault, std::string_view meant = {});

/// Fault of one number, or empty: "R is 5, not in 1e-05 .. 1 m".
[[nodiscard]] std::string fault_of_number(std::string_view name, std::string_view text,
                                          const NumberRange& range);

} // namespace tactus
