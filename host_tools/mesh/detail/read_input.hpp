// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <filesystem>
#include <string>

namespace tactus::detail
{

/// The name of standard input on a command line.
inline constexpr const char* kStandardInput = "-";

/// Reads a file as read_file() does, and also a pipe, a device or, by its name, standard input. It
/// waits for their end.
[[nodiscard]] Result<std::string, Refusal> read_input(const std::filesystem::path& path);

/// The name in messages.
[[nodiscard]] std::string input_name(const std::filesystem::path& path);

} // namespace tactus::detail
