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

/// What a decoder makes of some bytes.
struct Reading
{
    std::string refusal; ///< Empty when the bytes were taken.
    /// What was taken is in its ranges or encodes back to the same bytes; a refusal is worded as
    /// the format promises.
    bool is_lawful{true};
};

/// One reader of bytes from outside, and what its format says of the laws that all of them share.
struct Decoder
{
    std::string name;
    std::vector<Bytes> (*samples)();
    Reading (*read)(View bytes);
    std::string cut{};      ///< Stands in what is said of a sample that ends too early,
    std::string followed{}; ///< and of one that other bytes follow.
    /// Makes checksum and length fit what stands there; null where there are none or tests/fuzz
    /// does it.
    void (*seal)(std::span<std::byte> bytes){nullptr};
    std::vector<std::size_t> version_at{}; ///< Bytes of its versions, and
    std::string other_version{};           ///< what is said of any other one.
    std::vector<unsigned> versions{};      ///< First bytes that are read, where there are several.
    bool sees_every_flip{true};            ///< By a checksum. Otherwise a bit is read as it stands.
    bool tells_its_size{true};             ///< What is cut is refused under a right checksum, too.
    std::vector<std::size_t> whole_at{};   ///< Lengths at which a cut sample is a shorter one.
};

inline std::ostream& operator<<(std::ostream& out, const Decoder& decoder)
{
    return out << decoder.name;
}

[[nodiscard]] std::vector<Decoder> all_decoders();

} // namespace tactus::codec
