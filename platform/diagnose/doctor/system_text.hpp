// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

/// The forms in which the kernel writes numbers and processors. Each reads all of a text or none of
/// it.
namespace tactus::doctor
{

/// More than any kernel is built for.
inline constexpr std::size_t kMostProcessors = 8192;
using ProcessorSet = std::bitset<kMostProcessors>;

/// Decimal, with a sign or without.
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view text);
/// "0x1003" or "1003".
[[nodiscard]] std::optional<std::uint64_t> parse_hexadecimal(std::string_view text);
/// "0-3,5"; an empty text is an empty set.
[[nodiscard]] std::optional<ProcessorSet> parse_processor_list(std::string_view text);
/// "ff,ffffffff": hexadecimal in groups of 32 processors, the highest first.
[[nodiscard]] std::optional<ProcessorSet> parse_processor_mask(std::string_view text);

/// "0-3,5".
[[nodiscard]] std::string processor_list(const ProcessorSet& set);
/// "ff,ffffffff".
[[nodiscard]] std::string processor_mask(const ProcessorSet& set);
[[nodiscard]] std::optional<int> lowest_of(const ProcessorSet& set);
[[nodiscard]] std::optional<int> highest_of(const ProcessorSet& set);
[[nodiscard]] ProcessorSet set_of(int processor);

/// Whether a list of words, separated by white space, has this one.
[[nodiscard]] bool has_word(std::string_view list, std::string_view word);

/// A foreign text in quotes, as printable() shows it.
[[nodiscard]] std::string shown(std::string_view text);

/// A foreign text as one word of a shell, whatever is in it.
[[nodiscard]] std::string shell_word(std::string_view text);

} // namespace tactus::doctor
