// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/cli/command_line.hpp"

#include "platform/base/printable.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <string_view>
#include <utility>
#include <vector>

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

std::string trimmed(const std::string& text)
{
    const std::size_t first = text.find_first_not_of(" \t");
    return first == std::string::npos
               ? ""
               : text.substr(first, text.find_last_not_of(" \t\r") + 1 - first);
}

/// FILE:LINE of the first line that has this key, or all of whose text ends in it.
std::string place_of(const std::string& key, const std::string& path)
{
    std::ifstream file(path);
    int number = 0;
    for (std::string line; std::getline(file, line);)
    {
        ++number;
        const std::string name = trimmed(line.substr(0, line.find('=')));
        if (name == key || name == "[" + key + "]" || name.ends_with(" " + key))
        {
            return fmt::format("{}:{}", path, number);
        }
    }
    return path;
}

/// How many letters have to be put in, left out or exchanged to make one of the other
/// (Levenshtein).
std::size_t letters_between(std::string_view one, std::string_view other)
{
    std::vector<std::size_t> row(other.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < one.size(); ++i)
    {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < other.size(); ++j)
        {
            const std::size_t exchanged = diagonal + (one[i] == other[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({exchanged, diagonal + 1, row[j] + 1});
        }
    }
    return row.back();
}

/// The name that is most like the key; empty when none is.
std::string nearest_key(const CLI::App& app, const std::string& key)
{
    std::string nearest;
    std::size_t least = key.size() / 3 + 2;
    for (const CLI::Option* option : app.get_options())
    {
        for (const std::string& name : option->get_lnames())
        {
            const std::size_t letters = letters_between(key, name);
            if (option->get_configurable() && letters < least)
            {
                least = letters;
                nearest = name;
            }
        }
    }
    return nearest;
}

/// The library's own words for a key that no option has end in the key, and in "++" behind the name
/// of a section.
std::string unknown_key(const CLI::App& app, const CLI::ConfigError& error)
{
    std::string key = error.what();
    key = on_one_line(key.substr(key.rfind(' ') + 1));
    const auto path = app.get_config_ptr()->as<std::string>();
    const std::size_t section = key.find(".++");
    if (section != std::string::npos)
    {
        key.resize(section);
        return fmt::format("--config: {}: there are no sections; '[{}]' is one",
                           place_of(key, path), key);
    }
    const std::string nearest = nearest_key(app, key);
    return fmt::format("--config: {}: no option is called '{}'; {}", place_of(key, path), key,
                       nearest.empty() ? "a line is KEY = VALUE" : "'" + nearest + "'?");
}

} // namespace

CommandOption CommandOption::required() const
{
    option_->required();
    return *this;
}

CommandOption CommandOption::needs(CommandOption other) const
{
    option_->needs(other.option_);
    return *this;
}

CommandOption CommandOption::excludes(CommandOption other) const
{
    option_->excludes(other.option_);
    return *this;
}

CommandOption CommandOption::show_default() const
{
    option_->capture_default_str();
    return *this;
}

CommandOption CommandOption::number_between(double least, double most) const
{
    const std::string range = fmt::format("{} .. {}", least, most);
    return check(
        [=](const std::string& text)
        {
            double number = 0.0;
            const bool fits =
                CLI::detail::lexical_cast(text, number) && number >= least && number <= most;
            return fits ? std::string() : fmt::format("'{}' is not a number in {}", text, range);
        },
        range);
}

template <typename T>
CommandOption CommandOption::integer_between(T least, T most) const
{
    option_->check(CLI::Range(least, most));
    return *this;
}
template CommandOption CommandOption::integer_between(int, int) const;
template CommandOption CommandOption::integer_between(std::uint32_t, std::uint32_t) const;
template CommandOption CommandOption::integer_between(std::int64_t, std::int64_t) const;

CommandOption CommandOption::one_of(std::vector<std::string> names) const
{
    option_->check(CLI::IsMember(std::move(names)));
    return *this;
}

CommandOption CommandOption::existing_directory() const
{
    option_->check(CLI::ExistingDirectory);
    return *this;
}

CommandOption CommandOption::check(std::function<std::string(const std::string&)> fault_in,
                                   const std::string& form) const
{
    option_->check(CLI::Validator(std::move(fault_in), form));
    return *this;
}

CommandOption CommandOption::repeatable() const
{
    option_->expected(1)->allow_extra_args(false)->take_all();
    return *this;
}

CommandOption CommandOption::repeatable_with_more() const
{
    option_->expected(1)->take_all();
    return *this;
}

CommandOption CommandOption::separated_by(char delimiter) const
{
    option_->delimiter(delimiter);
    return *this;
}

CommandOption CommandOption::not_in_file() const
{
    option_->configurable(false);
    return *this;
}

CommandLine::CommandLine(const std::string& name, const std::string& description)
    : app_(std::make_unique<CLI::App>(description, name))
{
}

CommandLine::~CommandLine() = default;

void CommandLine::add_version(const std::string& version)
{
    app_->set_version_flag("--version", version);
}

template <typename T>
CommandOption CommandLine::add_option(const std::string& names, T& value,
                                      const std::string& description)
{
    return CommandOption(*app_->add_option(names, value, description));
}
#define TACTUS_OPTION_VALUE(T)                                                                     \
    template CommandOption CommandLine::add_option(const std::string&, T&, const std::string&)
TACTUS_OPTION_VALUE(int);
TACTUS_OPTION_VALUE(std::uint32_t);
TACTUS_OPTION_VALUE(std::int64_t);
TACTUS_OPTION_VALUE(double);
TACTUS_OPTION_VALUE(std::string);
TACTUS_OPTION_VALUE(std::filesystem::path);
TACTUS_OPTION_VALUE(std::vector<std::string>);
TACTUS_OPTION_VALUE(std::optional<int>);
TACTUS_OPTION_VALUE(std::optional<std::uint32_t>);
TACTUS_OPTION_VALUE(std::optional<double>);
TACTUS_OPTION_VALUE(std::optional<std::string>);
#undef TACTUS_OPTION_VALUE

CommandOption CommandLine::add_flag(const std::string& name, bool& value,
                                    const std::string& description)
{
    return CommandOption(*app_->add_flag(name, value, description));
}

void CommandLine::add_option_file(const std::string& name, const std::string& description)
{
    app_->set_config(name, "", description)->configurable(false);
    app_->allow_config_extras(CLI::config_extras_mode::error);
}

void CommandLine::set_footer(const std::string& text)
{
    app_->footer(text);
}

std::optional<int> CommandLine::parse(int argc, char** argv)
{
    try
    {
        app_->parse(argc, argv);
        return std::nullopt;
    }
    catch (const CLI::ConfigError& error)
    {
        const bool is_extra = std::string_view(error.what()).find("parse") != std::string::npos;
        return fail(is_extra ? unknown_key(*app_, error) : on_one_line(error.what()), kExitUsage);
    }
    catch (const CLI::FileError&)
    {
        return fail(fmt::format("--config: {}: can't be read, or is no file",
                                app_->get_config_ptr()->as<std::string>()),
                    kExitUsage);
    }
    catch (const CLI::ParseError& error)
    {
        if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success))
        {
            return app_->exit(error); // Prints the help or the version.
        }
        return fail(on_one_line(error.what()) + "; see --help", kExitUsage);
    }
}

std::vector<std::string> CommandLine::given() const
{
    std::vector<std::string> names;
    for (const CLI::Option* option : std::as_const(*app_).get_options())
    {
        if (option->count() > 0)
        {
            names.push_back(option->get_name());
        }
    }
    return names;
}

bool CommandLine::is_given(const std::string& name) const
{
    const CLI::Option* option = app_->get_option_no_throw(name);
    return option != nullptr && option->count() > 0;
}

std::string CommandLine::option_file_text() const
{
    return app_->config_to_str(true, true);
}

int CommandLine::fail(const std::string& text, int code) const
{
    fmt::print(stderr, "{}: {}\n", app_->get_name(), printable_line(text));
    return code;
}

} // namespace tactus
