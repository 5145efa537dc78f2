// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/options/option_table.hpp"

#include <span>
#include <string>

namespace tactus::hrtc
{

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
