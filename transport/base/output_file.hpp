// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"

#include <optional>
#include <string>

namespace tactus
{

/// Finds out before long work whether a file can be written; returns why not. An empty path is no
/// file.
[[nodiscard]] std::optional<Refusal> probe_output(const std::string& path);

/// Writes a text file whole or not at all; returns why not.
[[nodiscard]] std::optional<Refusal> write_text(const std::string& text, const std::string& path);

} // namespace tactus
