// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

/// Parsers for the kernel's forms of numbers and processors. Each reads the whole text or nothing.
namespace tactus::doctor
{

/// Most processors, more than any kernel supports.
inline constexpr std::size_t kMostProcessors = 8192;
using ProcessorSet = std::bitset<kMostProcessors>;

/// Decimal, with or without a sign.
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view text);
/// Hexadecimal, as "0x1003" or "1003".
[[nodiscard]] std::optional<std::uint64_t> parse_hexadecimal(std::string_view text);
/// List such as "0-3,5"; an empty text is an empty set.
[[nodiscard]] std::optional<ProcessorSet> parse_processor_list(std::string_view text);
/// Mask such as "ff,ffffffff": hexadecimal groups of 32 processors, the highest first.
[[nodiscard]] std::optional<ProcessorSet> parse_processor_mask(std::string_view text);

/// Text such as "0-3,5".
[[nodiscard]] std::string processor_list(const ProcessorSet& set);
/// Text such as "ff,ffffffff".
[[nodiscard]] std::string processor_mask(const ProcessorSet& set);
[[nodiscard]] std::optional<int> lowest_of(const ProcessorSet& set);
[[nodiscard]] std::optional<int> highest_of(const ProcessorSet& set);
[[nodiscard]] ProcessorSet set_of(int processor);

/// True if `list`, separated by white space, contains `word`.
[[nodiscard]] bool has_word(std::string_view list, std::string_view word);

/// Quoted text for display, with printable().
[[nodiscard]] std::string shown(std::string_view text);

/// Text quoted as one word for a shell, safe for any content.
[[nodiscard]] std::string shell_word(std::string_view text);

} // namespace tactus::doctor
