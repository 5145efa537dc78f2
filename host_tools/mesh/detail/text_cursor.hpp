// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace tactus::detail
{

/// What ends a line, a word and a number, and where a text begins, for every text format.

/// The text without the byte-order mark of UTF-8 that some editors write before it.
[[nodiscard]] std::string_view without_byte_order_mark(std::string_view text);

/// Walks over text by tokens or by lines and knows the line number, from 1. Lines end in LF, CR LF
/// or CR. Nothing depends on the locale.
class TextCursor
{
public:
    explicit TextCursor(std::string_view text, std::size_t first_line = 1)
        : text_(text), line_(first_line)
    {
    }

    /// The next run of characters without blanks, on this line or a later one; empty at the end.
    std::string_view next_token();
    /// The next token of this line only; empty at its end.
    std::string_view next_token_in_line();
    /// Goes to the start of the next line. False when there was no further character.
    bool skip_line();

    [[nodiscard]] bool at_end() const { return at_ == text_.size(); }
    [[nodiscard]] std::size_t position() const { return at_; }
    [[nodiscard]] std::size_t remaining() const { return text_.size() - at_; }
    [[nodiscard]] std::size_t line() const { return line_; }
    /// The error with the current line in front.
    [[nodiscard]] Refusal error(const std::string& what) const;

private:
    std::string_view text_;
    std::size_t at_{0};
    std::size_t line_;
};

/// The whole token as a number; a leading plus and Fortran's exponents (1.5D+02) are allowed. Too
/// small is 0, too large is infinite (and refused later, with all that is not finite).
[[nodiscard]] std::optional<double> parse_number(std::string_view token);
/// The same for whole numbers, which may be written with decimals (3.0) below 2^53.
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view token);
/// "'x', not a number", and what to do about a decimal comma.
[[nodiscard]] std::string no_number(std::string_view token);

/// The token in small letters, of ASCII alone.
[[nodiscard]] std::string lower(std::string_view token);

/// The token in quotes as it can stand in a message, whatever bytes it holds.
[[nodiscard]] std::string quote(std::string_view token);

} // namespace tactus::detail
