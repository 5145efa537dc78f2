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

/// A word from outside (a name, an option's value, a token of a file), fit for a message, as
/// printable_line() has it; what is longer than `longest` bytes ends in "...". By default a word
/// may be as long as a model's name.
[[nodiscard]] std::string printable(std::string_view text, std::size_t longest = 63);

/// A whole line of output: every byte that is neither ASCII nor part of a UTF-8 character becomes
/// '?', and so does every character that steers a terminal instead of being seen: controls (C0, C1,
/// U+007F), line and paragraph separators, and those that turn the direction of the text. Other
/// characters stay, since users give their files names in UTF-8.
[[nodiscard]] std::string printable_line(std::string_view text);

} // namespace tactus
