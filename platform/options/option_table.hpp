// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/options/options.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::hrtc
{

/// Texts of the command line that options.cpp reads once the line is parsed.
struct RawOptions
{
    std::vector<std::string> files; ///< Without an option.
    std::vector<std::string> models;
    std::vector<std::string> places;
    std::vector<std::string> materials;
    std::vector<std::string> tools;
    std::vector<std::string> tool_masses;
    std::vector<std::string> guides;
    std::optional<std::uint32_t> tool_count;
    std::vector<std::string> devices;
    std::optional<std::string> device_key;
    std::vector<std::string> device_limits;
    std::vector<std::string> device_frames;
    std::vector<std::string> device_faults;
    std::vector<std::string> motions;
    std::optional<std::string> transport;
    std::vector<std::string> failover;
    std::string prediction{prediction_name(Prediction::automatic)};
    std::optional<std::string> kernels;
    std::optional<int> cpu;
    bool prints_config{false};
    bool ignores_poses{false};
    bool hides_front{false};
    bool refines_always{false};
};

/// Declares all options of the command. Parsing fills `options` and `raw`, so both outlive `line`.
/// --help lists them in the order of their declaration.
void declare_options(CommandLine& line, Options& options, RawOptions& raw, const CommandForm& form);

} // namespace tactus::hrtc
