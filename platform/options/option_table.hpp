// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/udp/datagram.hpp"
#include "platform/options/options.hpp"
#include "platform/program/command_line.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::hrtc
{

/// Number of options with one value for each tool.
inline constexpr std::size_t kToolOptions = 8;

/// Texts of the command line that parse_options() parses further after CommandLine::parse().
struct RawOptions
{
    std::vector<std::string> files; ///< Files without an option.
    std::vector<std::string> models;
    std::vector<std::string> places;
    std::vector<std::string> materials;
    std::optional<std::uint32_t> tool_count;
    /// Values of each option of tool_options(), one a tool.
    std::array<std::vector<std::string>, kToolOptions> of_tools;
    /// Tables [[tool]] of the option file, one a tool.
    std::vector<OptionTable> tool_tables;
    std::optional<std::string> device_key;
    std::vector<std::string> device_faults;
    std::optional<std::string> transport;
    std::vector<std::string> failover;
    std::string prediction{prediction_name(Prediction::automatic)};
    std::optional<std::string> kernels;
    std::optional<int> cpu;
    bool prints_config{false};
    bool ignores_poses{false};
    bool hides_refinement_state{false};
    bool refines_always{false};
};

/// Declares all options of the command. Parsing fills `options` and `raw`, so both must outlive
/// `line`. --help lists the options in the order of declaration.
void declare_options(CommandLine& line, Options& options, RawOptions& raw, const CommandForm& form);

/// True if the text is a path, or the name of a model or scene file.
[[nodiscard]] bool is_file_name(const std::string& text, const FileReaders& readers);

/// Takes files without an option on the command line as values of --model or --scene. Without
/// --transport, chooses the transport: `file` if all names are files, `dds` if none is. Returns the
/// message for wrong usage; empty if there is none. `commands`: names of the program's other
/// commands, for that message.
[[nodiscard]] std::string assign_files(Options& options, RawOptions& raw,
                                       const std::string& commands);

/// Authenticator with the key in this file: 64 hexadecimal digits, with white space around them.
/// Tags are keyed BLAKE2b (RFC 7693) of 16 bytes. Refused if the file can't be read, has other
/// contents, or may be read by users besides its owner and group.
[[nodiscard]] Result<std::shared_ptr<const udp::Authenticator>, Refusal>
read_device_key(const std::string& path);

/// Option with one value for each tool, and its key in a table [[tool]].
struct ToolOption
{
    const char* key;
    const char* option;
    const char* help;
    /// Parses the text and sets it for the tool. Returns the fault; empty if there is none.
    std::string (*set)(const std::string& text, ToolOptions& tool);
};

/// Options of tools, in the order of RawOptions::of_tools, which is also the order of their
/// application: the device comes before its properties.
[[nodiscard]] std::span<const ToolOption, kToolOptions> tool_options();

/// Makes the tools of the options. Tool n takes the n-th value of each option, or else the value in
/// the n-th table. Without a value, or with the word none, the tool has the default. Returns the
/// fault; empty if there is none.
[[nodiscard]] std::string set_tools(Options& options, const RawOptions& raw);

/// Options of the tools, as tables of an option file.
[[nodiscard]] std::string tool_tables(const RawOptions& raw);

} // namespace tactus::hrtc
