// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <string_view>

namespace tactus
{

/// Writes the text to stdout, and out of its buffer. The text that stdout doesn't take, because its
/// reader is gone or its disk is full, is lost: a program that serves or touches goes on.
void print_out(std::string_view text) noexcept;

} // namespace tactus
