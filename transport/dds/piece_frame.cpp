// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/piece_frame.hpp"

#include <cstring>

namespace tactus::dds
{

void append_piece(std::vector<std::byte>& payload, const WireKey& key,
                  std::span<const std::byte> bytes)
{
    const auto length = static_cast<std::uint32_t>(bytes.size());
    const std::size_t start = payload.size();
    payload.resize(start + kFrameBytes + bytes.size());
    std::memcpy(payload.data() + start, &key, sizeof(key));
    std::memcpy(payload.data() + start + sizeof(key), &length, sizeof(length));
    std::memcpy(payload.data() + start + kFrameBytes, bytes.data(), bytes.size());
}

std::optional<PieceReader::Piece> PieceReader::next() noexcept
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

} // namespace tactus::dds
