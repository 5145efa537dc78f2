// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

// Any thread, but not the haptic one: texts allocate.
namespace tactus
{

/// Whether a byte is printable ASCII: no terminal obeys it, every log can hold it.
[[nodiscard]] constexpr bool is_printable(char c) noexcept
{
    return c >= ' ' && c <= '~';
}

/// A word from outside (a name, an option's value, a token of a file), fit for a message: bytes
/// that are not printable ASCII become '?', and what is longer than `longest` bytes ends in "...".
/// By default a word may be as long as a model's name.
[[nodiscard]] std::string printable(std::string_view text, std::size_t longest = 63);

/// A whole line of output: control characters, those beyond ASCII (C1, in UTF-8) as well, become
/// '?'. Other bytes above ASCII stay, since users give their files names in UTF-8.
[[nodiscard]] std::string printable_line(std::string_view text);

} // namespace tactus
