// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <string_view>

namespace tactus
{

/// Writes the text to stdout and flushes it. If the reader is gone or the disk is full, the text is
/// lost and the program goes on.
void print_out(std::string_view text) noexcept;

} // namespace tactus
