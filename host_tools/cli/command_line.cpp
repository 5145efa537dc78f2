// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/cli/command_line.hpp"

#include "platform/base/printable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <string_view>

namespace tactus
{

namespace
{

/// The library ends some messages with a line end and uses several lines for lists.
std::string on_one_line(std::string text)
{
    while (!text.empty() && text.back() == '\n')
    {
        text.pop_back();
    }
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

/// The library's own words for a key that no option has end in the key, and in "++" behind the name
/// of a section.
std::string unknown_key(const CLI::ConfigError& error)
{
    std::string key = error.what();
    key = on_one_line(key.substr(key.rfind(' ') + 1));
    const std::size_t section = key.find(".++");
    return section == std::string::npos
               ? fmt::format("--config: no option is called '{}'", key)
               : fmt::format("--config: there are no sections; '[{}]' is one",
                             key.substr(0, section));
}

} // namespace

std::optional<int> parse_command_line(CLI::App& app, int argc, char** argv)
{
    try
    {
        app.parse(argc, argv);
        return std::nullopt;
    }
    catch (const CLI::ConfigError& error)
    {
        const bool is_extra = std::string_view(error.what()).find("parse") != std::string::npos;
        return fail(app, is_extra ? unknown_key(error) : on_one_line(error.what()), kExitUsage);
    }
    catch (const CLI::ParseError& error)
    {
        if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success))
        {
            return app.exit(error); // Prints the help or the version.
        }
        return fail(app, on_one_line(error.what()) + "; see --help", kExitUsage);
    }
}

CLI::Validator number_between(double least, double most)
{
    const std::string range = fmt::format("{} .. {}", least, most);
    return CLI::Validator(
        [=](std::string& text)
        {
            double number = 0.0;
            const bool fits =
                CLI::detail::lexical_cast(text, number) && number >= least && number <= most;
            return fits ? std::string() : fmt::format("'{}' is not a number in {}", text, range);
        },
        range);
}

int fail(const CLI::App& app, const std::string& text, int code)
{
    fmt::print(stderr, "{}: {}\n", app.get_name(), printable_line(text));
    return code;
}

} // namespace tactus
