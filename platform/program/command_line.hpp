// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/exit_codes.hpp"
#include "transport/base/network_security.hpp"

#include <functional>
#include <map>
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
    std::string place; ///< Place as FILE:LINE.
};
using OptionTable = std::vector<TableEntry>;

/// Handle of a declared option, for further settings. Each function returns a copy of the handle.
/// The command line must outlive it.
class CommandOption
{
public:
    explicit CommandOption(CLI::Option& option) : option_(&option) {}

    CommandOption required() const;
    CommandOption needs(CommandOption other) const;
    CommandOption excludes(CommandOption other) const;
    /// Shows the variable's present value as the default in --help.
    CommandOption show_default() const;

    /// Accepts numbers from `least` to `most`, both included, and no NaN.
    CommandOption number_between(double least, double most) const;
    /// Accepts integers of the type int, std::uint32_t or std::int64_t; --help names the type.
    template <typename T>
    CommandOption integer_between(T least, T most) const;
    CommandOption one_of(std::vector<std::string> names) const;
    CommandOption existing_directory() const;
    /// Refuses a value for which `fault_in` returns a text, the fault. --help shows `form`.
    CommandOption check(std::function<std::string(const std::string&)> fault_in,
                        const std::string& form = "") const;

    /// Makes the option's value a list, with one value for each use of the option.
    CommandOption repeatable() const;
    /// Makes the option's value a list; each use of the option may have several values.
    CommandOption repeatable_with_more() const;
    CommandOption separated_by(char delimiter) const;
    /// Excludes the option from option files, both read and printed ones.
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
    /// Allows tables `[[name]]` in the option file, with any of these keys; other keys are wrong
    /// usage. Parsing appends the tables to `tables`, which must outlive the command line.
    void add_option_tables(const std::string& name, const std::vector<std::string>& keys,
                           std::vector<OptionTable>& tables);
    /// Adds --log-level and --json-log for the lines on stderr. parse() applies them.
    void add_log_options();
    /// Declares that the option `name` was called `former` in an older version, both without
    /// dashes. Use of the former name is wrong usage, and the message gives the new one.
    void add_former_name(const std::string& former, const std::string& name);
    /// Adds --security, --plain and --require-security, for programs that use DDS. Parsing refuses
    /// --plain beside one of the others. `security` must outlive parse().
    void add_security_options(NetworkSecurity& security);
    /// Begins a task, a section of --help: the options declared after this call stand in it, below
    /// the example.
    void begin_task(const std::string& task, const std::string& example);
    /// Sets the text below the options of --help. Lines that begin with a blank are not wrapped.
    void set_footer(const std::string& text);

    /// Parses the line. Returns the exit code after --help, --version, wrong usage or an unreadable
    /// option file. Both faults get one line on stderr. Returns nothing if the program should
    /// continue. `find_fault` checks the values of a valid line together: its text is wrong usage,
    /// and an empty one is none.
    [[nodiscard]] std::optional<int> parse(int argc, char** argv,
                                           const std::function<std::string()>& find_fault = {});

    /// Names of the given options, in the order of declaration.
    [[nodiscard]] std::vector<std::string> given() const;
    [[nodiscard]] bool is_given(const std::string& name) const;
    /// Text of an option file with all options and their present values.
    [[nodiscard]] std::string option_file_text() const;

    /// Writes one line on stderr with the program's name and the text, and returns `code`. Control
    /// characters, for instance of file names, are shown as '?'. If the text of a usage error
    /// begins with an option of the option file, the line's place there is put first.
    int fail(const std::string& text, int code = kExitFailed) const;

private:
    [[nodiscard]] std::string option_without_value() const;
    [[nodiscard]] std::string place_in_file(const std::string& text) const;
    [[nodiscard]] std::string place_tables();
    [[nodiscard]] std::string fault_of_security() const;

    void choose_log_style();

    std::string log_level_{"info"};
    bool logs_json_{false};
    std::vector<std::string> words_;      ///< Words of the command line after the program's name.
    std::string table_name_;              ///< Empty: the option file has no tables.
    std::vector<std::string> table_keys_; ///< Allowed keys of a table.
    std::vector<OptionTable>* tables_{nullptr};
    /// New name by former name, both without dashes.
    std::map<std::string, std::string> former_names_;
    std::unique_ptr<CLI::App> app_;
    const NetworkSecurity* security_{nullptr}; ///< Null: no DDS.
};

} // namespace tactus
