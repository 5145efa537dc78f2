// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/base/number_form.hpp"

#include "transport/base/printable.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <iterator>

namespace tactus
{

namespace
{

/// Number as text with `digits` significant digits; 0: the shortest exact text.
std::string text_of(double number, int digits = 0)
{
    std::array<char, 32> text{};
    const auto end = digits == 0 ? std::to_chars(text.begin(), text.end(), number).ptr
                                 : std::to_chars(text.begin(), text.end(), number,
                                                 std::chars_format::general, digits)
                                       .ptr;
    return {text.data(), end};
}

/// Conversion of a unit that a user may write: number x `factor` is in the unit `meant`.
struct WrittenUnit
{
    std::string_view written;
    std::string_view meant;
    double factor;
};
constexpr WrittenUnit kWrittenUnits[] = {
    {"um", "m", 1e-6},    {"mm", "m", 1e-3},       {"cm", "m", 1e-2},
    {"in", "m", 0.0254},  {"km", "m", 1e3},        {"g", "kg", 1e-3},
    {"N/mm", "N/m", 1e3}, {"deg", "degrees", 1.0}, {"mN", "N", 1e-3},
};

bool is_within(double number, const NumberRange& range)
{
    return (number >= range.least && number <= range.most) || (range.may_be_zero && number == 0.0);
}

/// Value of a number with a unit, converted to the option's unit; none if that is not possible.
std::optional<double> without_unit(std::string_view text, const NumberRange& range)
{
    const std::size_t digits = text.find_last_of("0123456789.") + 1; // 0 without digits.
    const std::optional<double> number = parse_number(text.substr(0, digits));
    const std::string_view unit = text.substr(digits);
    if (!number || range.unit.empty())
    {
        return std::nullopt;
    }
    if (unit == range.unit)
    {
        return number;
    }
    const auto* known =
        std::ranges::find_if(kWrittenUnits, [&](const WrittenUnit& entry)
                             { return entry.written == unit && entry.meant == range.unit; });
    return known == std::end(kWrittenUnits) ? std::nullopt : std::optional(*number * known->factor);
}

/// Number that the user probably intended, as text; empty if none is likely.
std::string meant_by(std::string_view text, const NumberRange& range)
{
    std::optional<double> number = parse_number(text);
    if (number && is_within(*number, range))
    {
        return std::string(text);
    }
    // A length above its range is probably in mm.
    number = !number                                  ? without_unit(text, range)
             : range.unit == "m" && range.most <= 1.0 ? std::optional(*number * 1e-3)
                                                      : std::nullopt;
    return number && is_within(*number, range) ? text_of(*number, 9) : std::string();
}

/// Names of a form's numbers, without brackets.
struct Names
{
    std::vector<std::string_view> all;
    std::vector<std::size_t> counts; ///< Allowed counts of numbers, ascending.
};

Names names_of(std::string_view text)
{
    Names names;
    for (std::size_t at = text.find(':') + 1; at <= text.size();) // 0 without a colon.
    {
        const std::size_t end = std::min(text.find_first_of(",[]", at), text.size());
        if (end > at)
        {
            names.all.push_back(text.substr(at, end - at));
        }
        if (end == text.size() || text[end] == '[')
        {
            names.counts.push_back(names.all.size());
        }
        at = end + 1;
    }
    return names;
}

std::vector<std::string_view> words_of(std::string_view text)
{
    std::vector<std::string_view> words;
    for (std::size_t at = 0; at <= text.size();)
    {
        const std::size_t comma = std::min(text.find(',', at), text.size());
        words.push_back(text.substr(at, comma - at));
        at = comma + 1;
    }
    return words;
}

/// Value that the user probably intended; empty if none is likely. If the form has no leading word,
/// zeros replace missing numbers.
std::string meant_by(const std::vector<std::string_view>& words, const NumberForm& form,
                     const Names& names)
{
    const auto count = std::ranges::lower_bound(names.counts, words.size());
    std::string text(form.text.substr(0, form.text.find(':') + 1));
    if (count == names.counts.end() || (*count > words.size() && !text.empty()))
    {
        return {};
    }
    for (std::size_t i = 0; i < *count; ++i)
    {
        const std::string number = meant_by(i < words.size() ? words[i] : "0", form.ranges[i]);
        if (number.empty())
        {
            return {};
        }
        text += (i == 0 ? "" : ",") + number;
    }
    return text;
}

} // namespace

std::string fault_of_number(std::string_view name, std::string_view text, const NumberRange& range)
{
    const std::optional<double> number = parse_number(text);
    if (number && is_within(*number, range))
    {
        return {};
    }
    if (number)
    {
        return std::string(name) + " is " + printable(text) + ", not in " + text_of(range.least) +
               " .. " + text_of(range.most) + (range.unit.empty() ? "" : " ") +
               std::string(range.unit) + (range.may_be_zero ? ", nor 0" : "");
    }
    if (without_unit(text, range))
    {
        return std::string(name) + " must be in " + std::string(range.unit) + ", without a unit";
    }
    return std::string(name) +
           (text.empty() ? " is missing" : " is '" + printable(text) + "', not a number");
}

Refusal not_of_form(std::string_view value, std::string_view form, std::string_view fault,
                    std::string_view meant)
{
    return {"'" + printable(value) + "' is not " + std::string(form) + ": " + std::string(fault) +
            (meant.empty() ? "" : "; " + std::string(meant) + "?")};
}

Result<std::vector<double>, Refusal> read_numbers(std::string_view value, const NumberForm& form)
{
    const Names names = names_of(form.text);
    TACTUS_ASSERT(names.all.size() == form.ranges.size());
    const std::size_t begin = form.text.find(':') + 1;
    const std::vector<std::string_view> words =
        words_of(value.substr(std::min(begin, value.size())));
    const auto refusal = [&](std::string_view fault)
    { return not_of_form(value, form.text, fault, meant_by(words, form, names)); };
    std::vector<double> numbers;
    for (std::size_t i = 0; i < std::min(words.size(), names.all.size()); ++i)
    {
        if (const std::string fault = fault_of_number(names.all[i], words[i], form.ranges[i]);
            !fault.empty())
        {
            return refusal(fault);
        }
        numbers.push_back(parse_number(words[i]).value());
    }
    if (std::ranges::count(names.counts, words.size()) == 0)
    {
        return refusal("the value has " + counted(words.size(), "number"));
    }
    return numbers;
}

std::optional<double> parse_number(std::string_view text)
{
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_whole = error == std::errc{} && end == text.data() + text.size();
    return is_whole && std::abs(value) < 1e300 ? std::optional(value) : std::nullopt;
}

} // namespace tactus
