// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

// Any thread, but not the haptic one: texts allocate.
namespace tactus
{

/// What one number of a value may be.
struct NumberRange
{
    double least;
    double most;
    std::string_view unit{}; ///< Empty: the number has none.
    bool may_be_zero{false}; ///< Besides the range.
};

/// A value of an option that consists of numbers with commas between.
struct NumberForm
{
    /// The names of the numbers, what may be left out in brackets, behind a word and a colon if it
    /// begins so: "box:X,Y,Z[,R]".
    std::string_view text;
    std::span<const NumberRange> ranges; ///< One a name.
};

/// Reads `value`, which begins with the word and the colon of the form. The refusal names the first
/// fault and, where one is near, the value that may have been meant: "'sphere:2mm' is not sphere:R:
/// R is in m, without a unit; sphere:0.002?"
[[nodiscard]] Result<std::vector<double>, Refusal> read_numbers(std::string_view value,
                                                                const NumberForm& form);

/// The refusal of a value that has this form, as read_numbers() words it. `meant` may be empty.
[[nodiscard]] Refusal not_of_form(std::string_view value, std::string_view form,
                                  std::string_view fault, std::string_view meant = {});

/// What is wrong with one number, empty when nothing is: "R is 5, not in 1e-05 .. 1 m".
[[nodiscard]] std::string fault_of_number(std::string_view name, std::string_view text,
                                          const NumberRange& range);

} // namespace tactus
