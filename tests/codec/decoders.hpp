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

/// What a decoder makes of some bytes.
struct Reading
{
    std::string refusal; ///< Empty when the bytes were taken.
    /// Of a refusal, that it is worded as the format's users know it; of what was taken, that it is
    /// in the format's ranges or encodes back to the same bytes.
    bool keeps_promise{true};
};

/// One reader of bytes from outside, and what its format says of the laws that all of them share.
struct Decoder
{
    std::string name;
    std::vector<Bytes> (*samples)();
    Reading (*read)(std::span<const std::byte> bytes);
    std::string cut;      ///< Stands in what is said of a sample that ends too early.
    std::string followed; ///< The same when other bytes follow it.
    /// Lengths at which a cut sample is a whole shorter one.
    std::vector<std::size_t> whole_at{};
    /// A checksum notices each changed bit. Otherwise what is taken may be what now stands there.
    bool sees_every_flip{true};
    /// Makes checksums and lengths fit whatever stands there now; null in a format without any, and
    /// where tests/fuzz does the same.
    void (*seal)(std::span<std::byte> bytes){nullptr};
    /// A cut sample is refused under a right checksum, too.
    bool tells_its_size{true};
    std::vector<std::size_t> version_at{}; ///< Places of the bytes of its versions.
    std::string unknown_version{};         ///< Stands in what is said of each other version.
};

inline std::ostream& operator<<(std::ostream& out, const Decoder& decoder)
{
    return out << decoder.name;
}

/// Of models: header, base mesh, index page, chunk and the whole file.
[[nodiscard]] std::vector<Decoder> model_decoders();

/// Of recordings and their parts, of device datagrams and of payloads with pieces.
[[nodiscard]] std::vector<Decoder> message_decoders();

} // namespace tactus::codec
