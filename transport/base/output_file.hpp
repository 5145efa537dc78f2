// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"

#include <optional>
#include <string>

namespace tactus
{

/// Tests, before a long run, whether a file can be written; returns the reason if not. An empty
/// path passes.
[[nodiscard]] std::optional<Refusal> probe_output(const std::string& path);

/// Writes a text file as a whole or not at all; returns the reason if it fails.
[[nodiscard]] std::optional<Refusal> write_text(const std::string& text, const std::string& path);

} // namespace tactus
