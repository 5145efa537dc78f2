// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/program/command_line.hpp"

#include "transport/base/program_log.hpp"
#include "transport/base/read_file.hpp"
#include "transport/base/suggestions.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>
#include <utility>

namespace tactus
{

namespace
{

/// Text on one line. Some of CLI11's messages end with a line end or hold lists of several lines.
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

/// Largest size of an option file in bytes.
constexpr std::uintmax_t kOptionFileMost = 1ULL << 20;

/// Checks the option file before CLI11 opens it, because reading a pipe or device may never end.
/// Throws the reason if it can't be read; else returns an empty text.
std::string check_option_file(const std::string& path)
{
    if (const auto bytes = read_file(path, kOptionFileMost); !bytes)
    {
        throw CLI::FileError(fmt::format("--config: {}: {}", path, bytes.error().text));
    }
    return {};
}

struct FilePlace
{
    std::string text;    ///< Place as FILE:LINE; FILE if no line was found.
    bool is_pair{false}; ///< The line is KEY = VALUE.
};

/// Place of the first line whose text before any '=' is `key` or [`key`], or ends in a blank and
/// `key`. If `tables` > 0, the search begins after the line of the `tables`-th [`table`].
FilePlace place_of(const std::string& key, const std::string& path, const std::string& table = "",
                   std::size_t tables = 0)
{
    std::ifstream file(path);
    int number = 0;
    for (std::string line; std::getline(file, line);)
    {
        ++number;
        if (tables > 0)
        {
            tables -= line.find("[" + table + "]") != std::string::npos ? 1U : 0U;
            continue;
        }
        const std::size_t equals = line.find('=');
        const std::string name = trimmed(line.substr(0, equals));
        if (name == key || name == "[" + key + "]" || name.ends_with(" " + key))
        {
            return {fmt::format("{}:{}", path, number), name == key && equals != line.npos};
        }
    }
    return {path};
}

/// True if `key` may appear in a message. Other text may be a secret, such as a password in a wrong
/// file.
bool is_like_a_name(const std::string& key)
{
    constexpr std::size_t kLongest = 32;
    const auto is_part = [](char c)
    { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_'; };
    return key.size() <= kLongest && std::ranges::all_of(key, is_part);
}

/// Text with "..." for the value that it quotes, which may be a secret by mistake.
std::string without_value(const std::string& text)
{
    const std::size_t first = text.find('\'');
    const std::size_t last = text.rfind('\'');
    return first == last ? text : text.substr(0, first + 1) + "..." + text.substr(last);
}

using FormerNames = std::map<std::string, std::string>;

/// Message that no option is called `key`, given without dashes. It proposes the option with that
/// former name, or else the most similar one, if any.
std::string no_option(const CLI::App& app, const FormerNames& former, const std::string& key,
                      bool is_in_file)
{
    const auto meant = [is_in_file](const std::string& name)
    { return is_in_file ? "'" + name + "'?" : "--" + name + "?"; };
    if (const auto found = former.find(key); found != former.end())
    {
        return fmt::format("{}an older version's name; {}", is_in_file ? "'" + key + "' is " : "",
                           meant(found->second));
    }
    std::vector<std::string_view> names;
    for (const CLI::Option* option : app.get_options())
    {
        if (option->get_configurable() || !is_in_file)
        {
            names.insert(names.end(), option->get_lnames().begin(), option->get_lnames().end());
        }
    }
    const std::string nearest = key.empty() ? "" : nearest_word(key, names);
    return fmt::format("no option is called {}; {}", is_in_file ? "'" + key + "'" : "so",
                       nearest.empty() ? "see --help" : meant(nearest));
}

/// Message for an unknown key. The library's own message ends in the key, or in the name of a
/// section and "++".
std::string unknown_key(const CLI::App& app, const CLI::ConfigError& error,
                        const FormerNames& former, const std::string& table)
{
    std::string key = error.what();
    key = on_one_line(key.substr(key.rfind(' ') + 1));
    const auto path = app.get_config_ptr()->as<std::string>();
    const std::size_t section = key.find(".++");
    if (section != std::string::npos)
    {
        key.resize(section);
        return fmt::format("--config: {}: begins a section; {}", place_of(key, path).text,
                           table.empty() ? "there are none" : "all are [[" + table + "]]");
    }
    const FilePlace place = place_of(key, path);
    if (!place.is_pair || !is_like_a_name(key))
    {
        return fmt::format("--config: {}: a line is KEY = VALUE", place.text);
    }
    return fmt::format("--config: {}: {}", place.text, no_option(app, former, key, true));
}

/// Message for the first unknown option, or else for the first unknown word.
std::string unknown_word(const CLI::App& app, const FormerNames& former)
{
    const std::vector<std::string> words = app.remaining();
    const auto option = std::ranges::find_if(words, [](const std::string& word)
                                             { return word.size() > 1 && word[0] == '-'; });
    if (option == words.end())
    {
        return fmt::format("'{}': nothing takes this word; see --help", words.front());
    }
    const std::string name = option->substr(0, option->find('='));
    const std::string letters = name.substr(std::min(name.find_first_not_of('-'), name.size()));
    return fmt::format("{}: {}", name, no_option(app, former, letters, false));
}

/// Message for a wrong number of values. The library's own message begins with the option's name
/// and states the number.
std::string wrong_count(const CLI::ArgumentMismatch& error)
{
    const std::string_view text = error.what();
    const std::string_view name = text.substr(0, text.find(':'));
    return fmt::format("{}: {}; see --help", name,
                       text.find("At Most") == std::string_view::npos ? "a value is missing"
                                                                      : "is given twice");
}

/// Message for a malformed value. The library's own message has the name after a colon and the
/// value after a '='.
std::string wrong_form(const CLI::ConversionError& error)
{
    const std::string_view text = error.what();
    const std::size_t name = text.find("--");
    return fmt::format("{}: a value isn't what it takes; see --help",
                       text.substr(std::min(name, text.size()), text.find(' ', name) - name));
}

/// Reader of option files that keeps tables of one name apart.
class TableReader : public CLI::ConfigTOML
{
public:
    TableReader(std::string name, std::vector<OptionTable>& tables)
        : name_(std::move(name)), tables_(&tables)
    {
    }

    std::vector<CLI::ConfigItem> from_config(std::istream& input) const override
    {
        std::vector<CLI::ConfigItem> all = CLI::ConfigTOML::from_config(input);
        std::erase_if(all, [this](const CLI::ConfigItem& item) { return try_take(item); });
        return all;
    }

private:
    /// Takes the item if it belongs to a table called name_. CLI11 marks the begin and end of a
    /// table by items called "++" and "--".
    [[nodiscard]] bool try_take(const CLI::ConfigItem& item) const
    {
        const bool begins = item.name == "++";
        if (item.parents.size() != 1 || item.parents[0] != name_ || (tables_->empty() && !begins))
        {
            return false;
        }
        if (begins)
        {
            tables_->emplace_back();
        }
        else if (item.name != "--")
        {
            tables_->back().push_back({item.name, CLI::detail::join(item.inputs, ","), {}});
        }
        return true;
    }

    std::string name_;
    std::vector<OptionTable>* tables_;
};

/// Text of the form "a, b or c".
std::string either(const std::vector<std::string>& names)
{
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i)
    {
        text += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + names[i];
    }
    return text;
}

/// Breaks the text between words into lines of at most `longest` characters.
std::string wrapped(const std::string& text, std::size_t longest)
{
    std::istringstream words(text);
    std::string lines;
    std::size_t length = 0;
    for (std::string word; words >> word;)
    {
        const bool fits = length + 1 + word.size() <= longest;
        lines += (lines.empty() ? "" : fits ? " " : "\n") + word;
        length = fits ? length + 1 + word.size() : word.size();
    }
    return lines;
}

/// Formatter of --help for a terminal's width, with an example for each task.
class TaskFormatter : public CLI::Formatter
{
public:
    std::map<std::string, std::string> examples; ///< Examples by the names of the tasks.

    [[nodiscard]] std::string make_option_desc(const CLI::Option* option) const override
    {
        const std::string value = option->get_default_str();
        const bool is_list = value.starts_with('[');
        const std::string shown = is_list ? value.substr(1, value.size() - 2) : value;
        const std::string end = value.empty() ? "" : " [default: " + shown + "]";
        return wrapped(option->get_description() + end, kWidth - get_column_width());
    }

    /// CLI11's text without the default, which make_option_desc() shows.
    [[nodiscard]] std::string make_option_opts(const CLI::Option* option) const override
    {
        std::string text = CLI::Formatter::make_option_opts(option);
        const std::string value = '=' + option->get_default_str();
        const std::size_t at = value.size() > 1 ? text.find(value) : std::string::npos;
        return at == std::string::npos ? text : text.erase(at, value.size());
    }

    [[nodiscard]] std::string make_group(std::string task, bool is_positional,
                                         std::vector<const CLI::Option*> options) const override
    {
        const auto example = examples.find(task);
        if (example == examples.end())
        {
            return CLI::Formatter::make_group(std::move(task), is_positional, std::move(options));
        }
        task += ", as in  " + example->second;
        const std::string text =
            CLI::Formatter::make_group(std::move(task), is_positional, std::move(options));
        return text.substr(1); // The library has already put a blank line before it.
    }

    [[nodiscard]] std::string make_footer(const CLI::App* app) const override
    {
        std::istringstream lines(app->get_footer());
        std::string text;
        for (std::string line; std::getline(lines, line);)
        {
            text += (line.starts_with(' ') ? line : wrapped(line, kWidth)) + '\n';
        }
        return text;
    }

private:
    static constexpr std::size_t kWidth = 100;
};

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
    const std::string range = fmt::format("{} .. {}", least, most);
    return check(
        [=](const std::string& text)
        {
            T number{};
            const bool fits =
                CLI::detail::lexical_cast(text, number) && number >= least && number <= most;
            return fits ? std::string()
                        : fmt::format("'{}' is not a whole number in {}", text, range);
        },
        range);
}
template CommandOption CommandOption::integer_between(int, int) const;
template CommandOption CommandOption::integer_between(std::uint32_t, std::uint32_t) const;
template CommandOption CommandOption::integer_between(std::int64_t, std::int64_t) const;

CommandOption CommandOption::one_of(std::vector<std::string> names) const
{
    const std::string choices = fmt::format("{{{}}}", fmt::join(names, ","));
    return check(
        [names = std::move(names)](const std::string& text)
        {
            return std::ranges::count(names, text) > 0
                       ? std::string()
                       : fmt::format("'{}' is not {}", text, either(names));
        },
        choices);
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
    app_->formatter(std::make_shared<TaskFormatter>());
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
    app_->set_config(name, "", description)
        ->configurable(false)
        ->check(CLI::Validator(check_option_file, ""));
    app_->allow_config_extras(CLI::config_extras_mode::error);
}

void CommandLine::add_option_tables(const std::string& name, const std::vector<std::string>& keys,
                                    std::vector<OptionTable>& tables)
{
    table_name_ = name;
    table_keys_ = keys;
    tables_ = &tables;
    app_->config_formatter(std::make_shared<TableReader>(name, tables));
}

void CommandLine::add_former_name(const std::string& former, const std::string& name)
{
    former_names_.emplace(former, name);
}

void CommandLine::add_security_options(NetworkSecurity& security)
{
    security_ = &security;
    add_option("--security", security.keys,
               "Folder of keys that tactus-keys made: the domain is joined with DDS Security, "
               "authenticated and encrypted [default: none]");
    add_flag("--plain", security.is_plain,
             "Join a network of CYCLONEDDS_URI without --security; every program on that network "
             "can take part. Not with --security or --require-security");
    add_flag("--require-security", security.is_required,
             "Refuse to join a domain without --security, on loopback too; for the option files of "
             "a site");
}

void CommandLine::begin_task(const std::string& task, const std::string& example)
{
    app_->option_defaults()->group(task);
    std::dynamic_pointer_cast<TaskFormatter>(app_->get_formatter())->examples[task] = example;
}

void CommandLine::set_footer(const std::string& text)
{
    app_->footer(text);
}

void CommandLine::add_log_options()
{
    begin_task("Messages on stderr", app_->get_name() + " ... --log-level warning --json-log");
    add_option("--log-level", log_level_, "Print only messages of this level or a more severe one")
        .one_of({kLogLevelNames.begin(), kLogLevelNames.end()})
        .show_default();
    add_flag("--json-log", logs_json_,
             "Print each message as a JSON object with the keys time (UTC), level, program and "
             "text");
}

void CommandLine::choose_log_style()
{
    const auto level = std::ranges::find(kLogLevelNames, log_level_) - kLogLevelNames.begin();
    set_log_style({static_cast<LogLevel>(level), logs_json_});
}

std::optional<int> CommandLine::parse(int argc, char** argv,
                                      const std::function<std::string()>& find_fault)
{
    words_.assign(argv + std::min(argc, 1), argv + argc);
    // Sets the log style early, for faults of the other options.
    set_log_style({LogLevel::info, app_->get_option_no_throw("--json-log") != nullptr &&
                                       std::ranges::count(words_, "--json-log") > 0});
    if (const std::string name = option_without_value(); !name.empty())
    {
        return fail(fmt::format("{}: a value is missing; see --help", name), kExitUsage);
    }
    try
    {
        app_->parse(argc, argv);
        choose_log_style();
        std::string fault = tables_ == nullptr ? "" : place_tables();
        fault = fault.empty() ? fault_of_security() : fault;
        fault = fault.empty() && find_fault ? find_fault() : fault;
        return fault.empty() ? std::nullopt : std::optional(fail(fault, kExitUsage));
    }
    catch (const CLI::ConfigError& error)
    {
        const bool is_extra = std::string_view(error.what()).find("parse") != std::string::npos;
        return fail(is_extra ? unknown_key(*app_, error, former_names_, table_name_)
                             : on_one_line(error.what()),
                    kExitUsage);
    }
    catch (const CLI::FileError& error)
    {
        return fail(error.what());
    }
    catch (const CLI::ExtrasError&)
    {
        return fail(unknown_word(*app_, former_names_), kExitUsage);
    }
    catch (const CLI::ArgumentMismatch& error)
    {
        return fail(wrong_count(error), kExitUsage);
    }
    catch (const CLI::ConversionError& error)
    {
        return fail(wrong_form(error), kExitUsage);
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

/// Name of the first option whose value is missing; empty if there is none. CLI11 would take the
/// next option for the value, also after '--option='.
std::string CommandLine::option_without_value() const
{
    const auto named = [this](const std::string& word)
    { return word.starts_with("--") ? app_->get_option_no_throw(word) : nullptr; };
    for (std::size_t i = 0; i < words_.size(); ++i)
    {
        const bool is_empty = words_[i].ends_with('=');
        const std::string name = words_[i].substr(0, words_[i].size() - (is_empty ? 1 : 0));
        const CLI::Option* option = named(name);
        const bool is_followed = i + 1 < words_.size() && named(words_[i + 1]) != nullptr;
        if (option != nullptr && option->get_items_expected_min() > 0 && (is_empty || is_followed))
        {
            return name;
        }
    }
    return {};
}

/// An option file may state that a flag is false; therefore the values decide.
std::string CommandLine::fault_of_security() const
{
    if (security_ == nullptr || !security_->is_plain ||
        (security_->keys.empty() && !security_->is_required))
    {
        return {};
    }
    return fmt::format("{} excludes --plain; see --help",
                       security_->keys.empty() ? "--require-security" : "--security");
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
    const std::string place = code == kExitUsage ? place_in_file(text) : "";
    log_message(LogLevel::error, app_->get_name(),
                place.empty() ? text : place + without_value(text));
    return code;
}

std::string CommandLine::place_in_file(const std::string& text) const
{
    const std::string name = text.substr(0, text.find_first_of(": "));
    const CLI::Option* file = app_->get_config_ptr();
    const CLI::Option* option = app_->get_option_no_throw(name);
    const bool is_on_the_line =
        std::ranges::any_of(words_, [&](const std::string& word)
                            { return word == name || word.starts_with(name + "="); });
    if (option == nullptr || !option->get_configurable() || file == nullptr || file->count() == 0 ||
        !name.starts_with("--") || is_on_the_line)
    {
        return {};
    }
    const auto path = file->as<std::string>();
    const std::string place = place_of(name.substr(2), path).text;
    return place == path ? "" : place + ": "; // Otherwise the option has no line in the file.
}

/// Sets the place of each key of the tables. Returns the first fault; empty if there is none.
std::string CommandLine::place_tables()
{
    const auto path = app_->get_config_ptr()->as<std::string>();
    for (std::size_t i = 0; i < tables_->size(); ++i)
    {
        OptionTable& table = (*tables_)[i];
        for (TableEntry& entry : table)
        {
            entry.place = place_of(entry.key, path, table_name_, i + 1).text;
            const std::string before =
                fmt::format("--config: {}: [[{}]]: ", entry.place, table_name_);
            if (std::ranges::count(table_keys_, entry.key) == 0)
            {
                return before + (is_like_a_name(entry.key) ? "'" + entry.key + "'" : "this") +
                       " is not " + either(table_keys_) +
                       (app_->get_option_no_throw("--" + entry.key) != nullptr
                            ? "; other options go above the tables"
                            : "");
            }
            if (std::ranges::count(table, entry.key, &TableEntry::key) > 1)
            {
                return before + entry.key + " is given twice";
            }
        }
    }
    return {};
}

} // namespace tactus
