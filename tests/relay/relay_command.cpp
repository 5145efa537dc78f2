// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/relay/relay_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>

namespace tactus::relay
{

namespace
{

struct Figure
{
    std::string_view name;
    double LinkCondition::*member;
    double most;
};

constexpr std::array<Figure, 4> kFigures{{{"delay-ms", &LinkCondition::delay_ms, kDelayMax_ms},
                                          {"jitter-ms", &LinkCondition::jitter_ms, kDelayMax_ms},
                                          {"loss", &LinkCondition::loss, 1.0},
                                          {"duplicates", &LinkCondition::duplicates, 1.0}}};

/// Number in 0 .. `most` that is all of `text`.
std::optional<double> parse_number(std::string_view text, double most)
{
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_whole = error == std::errc{} && end == text.data() + text.size();
    return is_whole && value >= 0.0 && value <= most ? std::optional(value) : std::nullopt;
}

/// Parses "FIGURE VALUE".
std::optional<Command> parse_set(std::string_view words)
{
    const std::size_t space = words.find(' ');
    const auto* const figure = std::ranges::find(kFigures, words.substr(0, space), &Figure::name);
    if (figure == kFigures.end() || space == std::string_view::npos)
    {
        return std::nullopt;
    }
    const std::optional<double> value = parse_number(words.substr(space + 1), figure->most);
    return value ? std::optional<Command>(Set{figure->member, *value}) : std::nullopt;
}

} // namespace

std::optional<Command> parse_command(std::string_view line)
{
    constexpr std::string_view kSet = "set ";
    if (line == "cut")
    {
        return Cut{};
    }
    if (line == "cut to-controller")
    {
        return Cut{true, false};
    }
    if (line == "cut to-server")
    {
        return Cut{false, true};
    }
    if (line == "restore")
    {
        return Restore{};
    }
    if (line == "count")
    {
        return Count{};
    }
    return line.starts_with(kSet) ? parse_set(line.substr(kSet.size())) : std::nullopt;
}

std::string command_forms()
{
    std::string forms = "cut, cut to-controller, cut to-server, restore, count";
    for (const Figure& figure : kFigures)
    {
        forms += fmt::format(", set {} 0..{}", figure.name, figure.most);
    }
    return forms;
}

} // namespace tactus::relay
