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

/// Entry of a table in an option file.
struct TableEntry
{
    std::string key;
    std::string value; ///< Value; a list is one text with commas.
    std::string place; ///< FILE:LINE.
};
using OptionTable = std::vector<TableEntry>;

/// Declared option, for further settings. Each function returns the option itself. The command line
/// must outlive it.
class CommandOption
{
public:
    explicit CommandOption(CLI::Option& option) : option_(&option) {}

    CommandOption required() const;
    CommandOption needs(CommandOption other) const;
    CommandOption excludes(CommandOption other) const;
    /// Shows the present value of the variable in --help.
    CommandOption show_default() const;

    /// Accepts numbers from `least` to `most`, both included, and no NaN.
    CommandOption number_between(double least, double most) const;
    /// Accepts integers of the type int, std::uint32_t or std::int64_t; --help names the type.
    template <typename T>
    CommandOption integer_between(T least, T most) const;
    CommandOption one_of(std::vector<std::string> names) const;
    CommandOption existing_directory() const;
    /// Refuses a value if `fault_in` returns its fault, not an empty text. --help shows `form`.
    CommandOption check(std::function<std::string(const std::string&)> fault_in,
                        const std::string& form = "") const;

    /// Makes a list with one value for each use of the option.
    CommandOption repeatable() const;
    /// Makes a list of all values, also of several after one use of the option.
    CommandOption repeatable_with_more() const;
    CommandOption separated_by(char delimiter) const;
    /// Excludes the option from the option file, for reading and for printing.
    CommandOption not_in_file() const;

private:
    CLI::Option* option_;
};

/// Options of a program. Only the source includes CLI11, whose headers take long to compile:
/// docs/internals/decisions/0003-command-line-room.md.
class CommandLine
{
public:
    CommandLine(const std::string& name, const std::string& description);
    ~CommandLine();
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;

    /// Adds --version, which prints `version`.
    void add_version(const std::string& version);
    /// Adds an option. Parsing writes to `value`, which must outlive it; without the option the
    /// value is unchanged. `names` are "-o,--output" or, for a value without a name, "FILE". The
    /// source lists the types of values; others do not link.
    template <typename T>
    CommandOption add_option(const std::string& names, T& value, const std::string& description);
    CommandOption add_flag(const std::string& name, bool& value, const std::string& description);
    /// Adds an option for a TOML file of options, whose keys are the options' names without the
    /// dashes. The command line overrides the file. An unknown key is wrong usage; an unreadable
    /// file is not.
    void add_option_file(const std::string& name, const std::string& description);
    /// Allows tables `[[name]]` with some of these keys in the option file. Parsing appends them to
    /// `tables`, which must live as long. Any other key is wrong usage.
    void add_option_tables(const std::string& name, const std::vector<std::string>& keys,
                           std::vector<OptionTable>& tables);
    /// Adds --log-level and --json-log for the lines on stderr. parse() applies them.
    void add_log_options();
    /// Begins a task: --help shows the options declared after this call under it, with the example.
    void begin_task(const std::string& task, const std::string& example);
    /// Sets the text below the options of --help. Lines that begin with a blank are not wrapped.
    void set_footer(const std::string& text);

    /// Parses the line. Returns the exit code after --help, --version, wrong usage or an unreadable
    /// option file. Both faults get one line on stderr. Returns nothing if the program should
    /// continue.
    [[nodiscard]] std::optional<int> parse(int argc, char** argv);

    /// Names of the given options, in the order of declaration.
    [[nodiscard]] std::vector<std::string> given() const;
    [[nodiscard]] bool is_given(const std::string& name) const;
    /// Options with their present values, as an option file.
    [[nodiscard]] std::string option_file_text() const;

    /// Writes one line on stderr, with the program's name and the reason of a failure. Returns
    /// `code`. Control characters, for instance of file names, are shown as '?'. If a usage error
    /// begins with an option of the option file, its place there is put first.
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
