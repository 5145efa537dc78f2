// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <string_view>

// Any thread; results depend on the arguments alone.
namespace tactus
{

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
