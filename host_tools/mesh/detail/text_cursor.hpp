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

/// Rules that all text formats share: beginning of a text, ends of lines, words and numbers.

/// Text without the byte-order mark of UTF-8 that some editors write before it.
[[nodiscard]] std::string_view without_byte_order_mark(std::string_view text);

/// Reads text by tokens or by lines and counts lines from 1. Lines end in LF, CR LF or CR.
/// Independent of the locale.
class TextCursor
{
public:
    explicit TextCursor(std::string_view text, std::size_t first_line = 1)
        : text_(text), line_(first_line)
    {
    }

    /// The next run of characters without blanks, on this line or a later one; empty at the end.
    std::string_view next_token();
    /// The next token of this line only; empty at the line's end.
    std::string_view next_token_in_line();
    /// Moves to the start of the next line. False at the end of the text.
    bool skip_line();

    [[nodiscard]] bool at_end() const { return at_ == text_.size(); }
    [[nodiscard]] std::size_t position() const { return at_; }
    [[nodiscard]] std::size_t remaining() const { return text_.size() - at_; }
    [[nodiscard]] std::size_t line() const { return line_; }
    /// Refusal that begins with the current line.
    [[nodiscard]] Refusal error(const std::string& what) const;

private:
    std::string_view text_;
    std::size_t at_{0};
    std::size_t line_;
};

/// Number that the whole token spells; a leading plus and Fortran's exponents (1.5D+02) are
/// allowed. Values below the range become 0, above it infinite (and are refused later).
[[nodiscard]] std::optional<double> parse_number(std::string_view token);
/// Integer that the whole token spells; below 2^53 it may have the form of a number, such as 3.0.
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view token);
/// Message "'x', not a number", with a remedy for a decimal comma.
[[nodiscard]] std::string no_number(std::string_view token);

/// Token in lower case, for ASCII only.
[[nodiscard]] std::string lower(std::string_view token);

/// Token in quotes, safe for a message with any bytes.
[[nodiscard]] std::string quote(std::string_view token);

} // namespace tactus::detail
