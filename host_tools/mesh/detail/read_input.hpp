// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <filesystem>
#include <string>

namespace tactus::detail
{

/// Name of standard input on a command line.
inline constexpr const char* kStandardInput = "-";

/// Reads a file like read_file(), or a pipe, a device or standard input (by its name) to its end.
[[nodiscard]] Result<std::string, Refusal> read_input(const std::filesystem::path& path);

/// Name of an input for messages.
[[nodiscard]] std::string input_name(const std::filesystem::path& path);

} // namespace tactus::detail
