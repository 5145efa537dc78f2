// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/piece_requests.hpp"

#include "transport/dds/piece_frame.hpp"

#include <algorithm>

#include "tactus.h"

namespace tactus::dds
{

std::uint32_t PieceRequests::take(const tactus_v5_Wanted& wanted,
                                  std::span<const ModelPieces> models)
{
    std::uint32_t refused = 0;
    for (const tactus_v5_PieceName& name : std::span(wanted.pieces._buffer, wanted.pieces._length))
    {
        const ContentKey key{static_cast<ContentKind>(name.kind), name.number};
        if (name.model < models.size() && models[name.model].has(key))
        {
            add({name.model, key}, wanted.generation);
        }
        else
        {
            ++refused;
        }
    }
    return refused;
}

void PieceRequests::set_credit(const Credit& credit) noexcept
{
    const std::uint64_t seen = std::min(credit.seen, sent_);
    lost_ = seen - std::min(credit.received, seen);
    credit_.seen = std::max(credit_.seen, seen);
    credit_.granted =
        std::max(credit_.granted, std::min(credit.granted, credit_.seen + kCreditPieces));
    credit_.received = std::max(credit_.received, credit.received);
}

std::uint64_t PieceRequests::fill(std::span<const ModelPieces> models, PieceBuffers& room,
                                  RateLimitedLog& log)
{
    room.payload.clear();
    std::uint64_t pieces = 0;
    while (!queue_.empty() && sent_ + pieces < credit_.granted)
    {
        const ServerPiece request = queue_.front();
        const ModelPieces& model = models[request.model];
        if (room.payload.size() + kFrameBytes + model.bytes(request.key) > kPayloadBytes)
        {
            break;
        }
        queue_.pop_front();
        if (auto done = model.read(request.key, room.piece); !done)
        {
            log.write(done.error().text);
            continue;
        }
        append_piece(room.payload,
                     {model.store().hash(), model.store().revision(),
                      static_cast<std::uint32_t>(request.key.kind), request.key.number},
                     room.piece);
        ++pieces;
    }
    return pieces;
}

} // namespace tactus::dds
