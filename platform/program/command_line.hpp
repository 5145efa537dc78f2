// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/exit_codes.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI
{
class App;
class Option;
} // namespace CLI

namespace tactus
{

/// A key of a table in an option file.
struct TableEntry
{
    std::string key;
    std::string value; ///< A list is one text with commas.
    std::string place; ///< FILE:LINE.
};
using OptionTable = std::vector<TableEntry>;

/// A declared option, to say more about it: each function returns the option again. It lives as
/// long as its command line.
class CommandOption
{
public:
    explicit CommandOption(CLI::Option& option) : option_(&option) {}

    CommandOption required() const;
    CommandOption needs(CommandOption other) const;
    CommandOption excludes(CommandOption other) const;
    /// --help shows the value that the variable has now.
    CommandOption show_default() const;

    /// Accepts numbers from `least` to `most`, both included, and no NaN.
    CommandOption number_between(double least, double most) const;
    /// The same for int, std::uint32_t and std::int64_t; --help names the type.
    template <typename T>
    CommandOption integer_between(T least, T most) const;
    CommandOption one_of(std::vector<std::string> names) const;
    CommandOption existing_directory() const;
    /// `fault_in` tells what is wrong with a value, empty when nothing is. --help shows `form`.
    CommandOption check(std::function<std::string(const std::string&)> fault_in,
                        const std::string& form = "") const;

    /// A list with one value each time that the option is given.
    CommandOption repeatable() const;
    /// The same, but values that follow at once belong to the list, too.
    CommandOption repeatable_with_more() const;
    CommandOption separated_by(char delimiter) const;
    /// The option file neither sets nor shows it.
    CommandOption not_in_file() const;

private:
    CLI::Option* option_;
};

/// The options of a program. The only place that includes CLI11, whose headers take long to
/// compile: docs/internals/decisions/0003-command-line-room.md.
class CommandLine
{
public:
    CommandLine(const std::string& name, const std::string& description);
    ~CommandLine();
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;

    /// --version, which prints `version`.
    void add_version(const std::string& version);
    /// Parsing writes to `value`, which must live as long; without the option it stays as it is.
    /// `names` are "-o,--output" or, for a value without a name, "FILE". The types of values are
    /// listed in the source; any other does not link.
    template <typename T>
    CommandOption add_option(const std::string& names, T& value, const std::string& description);
    CommandOption add_flag(const std::string& name, bool& value, const std::string& description);
    /// An option that names a TOML file of options: keys are their names without the dashes. The
    /// command line goes first; a key that no option has is wrong usage, a file that can't be read
    /// is not.
    void add_option_file(const std::string& name, const std::string& description);
    /// The option file may have tables `[[name]]`, each with some of these keys. Parsing appends
    /// them to `tables`, which must live as long. Any other key is wrong usage.
    void add_option_tables(const std::string& name, const std::vector<std::string>& keys,
                           std::vector<OptionTable>& tables);
    /// --log-level and --json-log: how much is told on stderr, and how. parse() puts them into
    /// effect.
    void add_log_options();
    /// What is declared from here on is for this task; --help shows it by tasks, each with its
    /// example.
    void begin_task(const std::string& task, const std::string& example);
    /// Text below the options of --help; lines that begin with a blank stay as they are.
    void set_footer(const std::string& text);

    /// Returns the code to leave with after --help or --version, and after wrong usage or an option
    /// file that can't be read, which gets one line on stderr; nothing when the program should go
    /// on.
    [[nodiscard]] std::optional<int> parse(int argc, char** argv);

    /// The names of the options that the user gave, in the order of their declaration.
    [[nodiscard]] std::vector<std::string> given() const;
    [[nodiscard]] bool is_given(const std::string& name) const;
    /// What the options come to, as an option file.
    [[nodiscard]] std::string option_file_text() const;

    /// Says in one line on stderr, behind the program's name, why it fails; returns `code`. Control
    /// characters of file names and the like are shown as '?'. Where the text of wrong usage begins
    /// with an option that stands in the option file, its place there goes before.
    int fail(const std::string& text, int code = kExitFailed) const;

private:
    [[nodiscard]] std::string option_without_value() const;
    [[nodiscard]] std::string place_in_file(const std::string& text) const;
    [[nodiscard]] std::string place_tables();

    void choose_log_style();

    std::string log_level_{"info"};
    bool logs_json_{false};
    std::vector<std::string> words_;      ///< Words of the command line after the program's name.
    std::string table_name_;              ///< Empty: the option file has no tables.
    std::vector<std::string> table_keys_; ///< Allowed keys of a table.
    std::vector<OptionTable>* tables_{nullptr};
    std::unique_ptr<CLI::App> app_;
};

} // namespace tactus
