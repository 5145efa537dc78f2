// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <ostream>
#include <span>
#include <string>
#include <vector>

namespace tactus::codec
{

using Bytes = std::vector<std::byte>;
using View = std::span<const std::byte>;

/// Result of a decoder for some bytes.
struct Reading
{
    std::string refusal; ///< Refusal; empty if the bytes were accepted.
    /// True if accepted values are in their ranges or encode back to the same bytes, and a refusal
    /// has the words of the format.
    bool is_lawful{true};
};

/// Reader of external bytes, with the properties of its format among the laws that all readers
/// share.
struct Decoder
{
    std::string name;
    std::vector<Bytes> (*samples)();
    Reading (*read)(View bytes);
    std::string cut{};      ///< Part of the refusal of a sample that ends too early.
    std::string followed{}; ///< Part of the refusal of a sample with bytes after it.
    /// Corrects checksum and length; null if there are none or tests/fuzz does it.
    void (*seal)(std::span<std::byte> bytes){nullptr};
    std::vector<std::size_t> version_at{}; ///< Places of the version bytes.
    std::string other_version{};           ///< Part of the refusal of another version.
    std::vector<unsigned> versions{};      ///< Accepted first bytes, if there are several.
    /// True if a checksum detects every flipped bit; otherwise the bit is read.
    bool sees_every_flip{true};
    /// True if a truncated sample is refused even with a correct checksum.
    bool tells_its_size{true};
    /// Lengths at which a truncated sample is a valid shorter one.
    std::vector<std::size_t> whole_at{};
};

inline std::ostream& operator<<(std::ostream& out, const Decoder& decoder)
{
    return out << decoder.name;
}

[[nodiscard]] std::vector<Decoder> all_decoders();

} // namespace tactus::codec
