// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

// Any thread except the haptic one: strings allocate.
namespace tactus
{

/// True if a byte is printable ASCII: harmless to a terminal and to every log.
[[nodiscard]] constexpr bool is_printable(char c) noexcept
{
    return c >= ' ' && c <= '~';
}

/// Name, option or token from outside, made fit for a message by printable_line(). Text beyond
/// `longest` bytes is replaced by "...". [default: the length of a model's name]
[[nodiscard]] std::string printable(std::string_view text, std::size_t longest = 63);

/// Line of output without control characters. '?' replaces each byte that is not UTF-8 and each
/// character that controls a terminal: controls (C0, C1, U+007F), line and paragraph separators,
/// and changes of text direction. Other characters stay, since file names are in UTF-8.
[[nodiscard]] std::string printable_line(std::string_view text);

/// True if printable_line() changes nothing.
[[nodiscard]] bool is_printable_line(std::string_view text);

/// Bytes of the first character, 1 to 4; 0 if the text is empty or does not begin with UTF-8 (RFC
/// 3629).
[[nodiscard]] std::size_t character_bytes(std::string_view text) noexcept;

/// Longest beginning of a UTF-8 text with whole characters and at most `longest` bytes.
[[nodiscard]] std::string_view whole_characters(std::string_view text,
                                                std::size_t longest) noexcept;

/// True if a character of more than one byte is a letter or a similar visible sign. False for
/// controls, blanks, quotation marks, joiners, invisible and private characters, and changes of
/// text direction.
[[nodiscard]] bool is_letter(std::string_view character) noexcept;

} // namespace tactus
