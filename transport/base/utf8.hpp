// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <string_view>

// Any thread: values.
namespace tactus
{

/// Bytes of the first character of a text, 1 to 4; 0 if it is not UTF-8 (RFC 3629) or the text is
/// empty.
[[nodiscard]] std::size_t character_bytes(std::string_view text) noexcept;

/// Beginning of a UTF-8 text: `longest` bytes, or fewer if these would cut a character.
[[nodiscard]] std::string_view whole_characters(std::string_view text,
                                                std::size_t longest) noexcept;

/// True if a character of more than one byte is a letter or a similar visible sign. Controls,
/// blanks, quotation marks, joiners, invisible and private characters, and changes of text
/// direction are none.
[[nodiscard]] bool is_letter(std::string_view character) noexcept;

} // namespace tactus
