// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/options/option_table.hpp"

#include <span>
#include <string>

namespace tactus::hrtc
{

/// An option of which each tool has a value of its own, and its key in a table [[tool]].
struct ToolOption
{
    const char* key;
    const char* option;
    const char* help;
    /// Sets what the text says of the tool. Returns what is wrong with it; empty when all is well.
    std::string (*set)(const std::string& text, ToolOptions& tool);
};

/// In the order of RawOptions::of_tools, in which they are set: what a device is comes before what
/// is true of it.
[[nodiscard]] std::span<const ToolOption, kToolOptions> tool_options();

/// Makes the tools: the n-th value of an option is tool n's, else that of the n-th table; without
/// either, and for the word none, the tool has the default. Returns what is wrong; empty when all
/// is well.
[[nodiscard]] std::string take_tools(Options& options, const RawOptions& raw);

/// What was said of the tools, as tables of an option file.
[[nodiscard]] std::string tool_tables(const RawOptions& raw);

} // namespace tactus::hrtc
