// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/doctor/machine_view.hpp"
#include "transport/base/printable.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <vector>

namespace tactus::doctor
{

namespace
{

template <typename Number>
std::optional<Number> parse_whole(std::string_view text, int base)
{
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
    const bool is_whole = error == std::errc{} && end == text.data() + text.size();
    return is_whole ? std::optional(value) : std::nullopt;
}

std::vector<std::string_view> split(std::string_view text, char separator)
{
    std::vector<std::string_view> parts;
    for (std::size_t at = 0; at <= text.size();)
    {
        const std::size_t end = std::min(text.find(separator, at), text.size());
        parts.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return parts;
}

} // namespace

std::optional<std::int64_t> parse_integer(std::string_view text)
{
    return parse_whole<std::int64_t>(text, 10);
}

std::optional<std::uint64_t> parse_hexadecimal(std::string_view text)
{
    return parse_whole<std::uint64_t>(text.starts_with("0x") ? text.substr(2) : text, 16);
}

std::optional<ProcessorSet> parse_processor_list(std::string_view text)
{
    ProcessorSet set;
    if (text.empty())
    {
        return set;
    }
    for (const std::string_view range : split(text, ','))
    {
        const std::size_t dash = std::min(range.find('-'), range.size());
        const auto first = parse_whole<std::uint32_t>(range.substr(0, dash), 10);
        const auto last =
            dash == range.size() ? first : parse_whole<std::uint32_t>(range.substr(dash + 1), 10);
        if (!first || !last || *last < *first || *last >= kMostProcessors)
        {
            return std::nullopt;
        }
        for (std::size_t processor = *first; processor <= *last; ++processor)
        {
            set.set(processor);
        }
    }
    return set;
}

std::optional<ProcessorSet> parse_processor_mask(std::string_view text)
{
    constexpr std::size_t kGroupBits = 32;
    ProcessorSet set;
    std::vector<std::string_view> groups = split(text, ',');
    if (groups.size() > kMostProcessors / kGroupBits)
    {
        return std::nullopt;
    }
    std::ranges::reverse(groups);
    for (std::size_t i = 0; i < groups.size(); ++i)
    {
        const auto bits = parse_whole<std::uint32_t>(groups[i], 16);
        if (!bits)
        {
            return std::nullopt;
        }
        set |= ProcessorSet(*bits) << (i * kGroupBits);
    }
    return set;
}

std::string processor_list(const ProcessorSet& set)
{
    std::string list;
    for (std::size_t at = 0; at < set.size(); ++at)
    {
        const std::size_t first = at;
        while (at < set.size() && set.test(at))
        {
            ++at;
        }
        if (at == first)
        {
            continue;
        }
        list += (list.empty() ? "" : ",") + std::to_string(first);
        list += at - first > 1 ? "-" + std::to_string(at - 1) : "";
    }
    return list;
}

std::string processor_mask(const ProcessorSet& set)
{
    const ProcessorSet one_group(0xFFFFFFFFU);
    std::string mask;
    for (std::size_t group = kMostProcessors / 32; group-- > 0;)
    {
        const unsigned long bits = ((set >> (group * 32)) & one_group).to_ulong();
        std::string digits(9, '\0');
        const int length =
            std::snprintf(digits.data(), digits.size(), mask.empty() ? "%lx" : "%08lx", bits);
        digits.resize(static_cast<std::size_t>(length));
        if (!mask.empty() || bits != 0 || group == 0)
        {
            mask += (mask.empty() ? "" : ",") + digits;
        }
    }
    return mask;
}

std::optional<int> lowest_of(const ProcessorSet& set)
{
    for (std::size_t processor = 0; processor < set.size(); ++processor)
    {
        if (set.test(processor))
        {
            return static_cast<int>(processor);
        }
    }
    return std::nullopt;
}

std::optional<int> highest_of(const ProcessorSet& set)
{
    for (std::size_t processor = set.size(); processor-- > 0;)
    {
        if (set.test(processor))
        {
            return static_cast<int>(processor);
        }
    }
    return std::nullopt;
}

ProcessorSet set_of(int processor)
{
    return ProcessorSet().set(static_cast<std::size_t>(processor));
}

bool has_word(std::string_view list, std::string_view word)
{
    constexpr std::string_view kWhite = " \t\n";
    for (std::size_t at = list.find_first_not_of(kWhite); at != std::string_view::npos;)
    {
        const std::size_t end = std::min(list.find_first_of(kWhite, at), list.size());
        if (list.substr(at, end - at) == word)
        {
            return true;
        }
        at = list.find_first_not_of(kWhite, end);
    }
    return false;
}

std::string shown(std::string_view text)
{
    return "'" + printable(text) + "'";
}

std::string shell_word(std::string_view text)
{
    std::string word = "'";
    for (const char c : text)
    {
        if (c == '\'')
        {
            word += R"('\'')";
        }
        else
        {
            word += is_printable(c) ? c : '?';
        }
    }
    return word + "'";
}

} // namespace tactus::doctor
