// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/byte_io.hpp"
#include "rt_core/spm/content_key.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

namespace tactus::dds
{

/// Size of the frame before each piece in a payload: its WireKey and its length.
inline constexpr std::size_t kFrameBytes = sizeof(WireKey) + sizeof(std::uint32_t);

/// Appends a framed piece to a payload. No allocation while the payload's capacity suffices.
inline void append_piece(std::vector<std::byte>& payload, const WireKey& key,
                         std::span<const std::byte> bytes)
{
    const auto length = static_cast<std::uint32_t>(bytes.size());
    const std::size_t start = payload.size();
    payload.resize(start + kFrameBytes + bytes.size());
    std::memcpy(payload.data() + start, &key, sizeof(key));
    std::memcpy(payload.data() + start + sizeof(key), &length, sizeof(length));
    std::memcpy(payload.data() + start + kFrameBytes, bytes.data(), bytes.size());
}

/// Reads the framed pieces of an untrusted payload, one by one.
class PieceReader
{
public:
    struct Piece
    {
        WireKey key;
        std::span<const std::byte> bytes;
    };

    explicit PieceReader(std::span<const std::byte> payload) noexcept : reader_(payload) {}

    /// The next piece; none at the end or if the framing is broken.
    [[nodiscard]] std::optional<Piece> next() noexcept
    {
        if (reader_.at_end())
        {
            return std::nullopt;
        }
        Piece piece;
        piece.key = reader_.read<WireKey>();
        const auto length = reader_.read<std::uint32_t>();
        piece.bytes = reader_.read_bytes(length);
        return reader_.failed() ? std::nullopt : std::optional(piece);
    }

    /// True if next() found a frame or piece that is cut off.
    [[nodiscard]] bool is_broken() const noexcept { return reader_.failed(); }

private:
    ByteReader reader_;
};

} // namespace tactus::dds
