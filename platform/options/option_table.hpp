// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/options/options.hpp"
#include "platform/program/command_line.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
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

} // namespace tactus::hrtc
