// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <string_view>

// Any thread: values.
namespace tactus
{

/// How many bytes the character has that begins the text, 1 to 4; 0: it is no UTF-8 (RFC 3629), or
/// the text is empty.
[[nodiscard]] std::size_t character_bytes(std::string_view text) noexcept;

/// The beginning of a text in UTF-8: `longest` bytes, or fewer where these would cut a character.
[[nodiscard]] std::string_view whole_characters(std::string_view text,
                                                std::size_t longest) noexcept;

/// Whether a character of more than one byte is a letter, or a sign that is seen like one: no
/// control, blank, quotation mark or joiner, none that is invisible or of private use, and nothing
/// that turns the direction of a text.
[[nodiscard]] bool is_letter(std::string_view character) noexcept;

} // namespace tactus
