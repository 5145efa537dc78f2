// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/content_key.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace tactus
{

/// Receives the pieces that a link delivers. `bytes` are the piece's coded form, not verified, and
/// valid only during the call. A base mesh arrives in parts (transport/piece_parts.hpp); the key's
/// number is that of the part.
class PieceSink
{
public:
    virtual void receive(ContentKey key, std::span<const std::byte> bytes) = 0;

protected:
    ~PieceSink() = default;
};

enum class LinkState : std::uint8_t
{
    connected,
    host_gone, ///< No server has this model at present; one may return.
};

/// Source of one model's base mesh, index pages and chunks: a local file, a server on the network,
/// or a stand-in for one. Used by one thread, the transport thread; no call waits, except for a
/// file's disk.
///
/// A link may lose, repeat, reorder and damage pieces: the ChunkLoader verifies them and requests
/// them again.
class ChunkLink
{
public:
    ChunkLink() = default;
    virtual ~ChunkLink() = default;
    ChunkLink(const ChunkLink&) = delete;
    ChunkLink& operator=(const ChunkLink&) = delete;
    ChunkLink(ChunkLink&&) = delete;
    ChunkLink& operator=(ChunkLink&&) = delete;

    /// Requests pieces that the model has, highest priority first. A newer generation goes before
    /// requests that still wait.
    virtual void request(std::span<const ContentKey> keys, std::uint32_t generation) = 0;

    /// Reports that a piece has a wrong hash. Called in receive(), or after it for a complete base
    /// mesh. True if a further request makes sense: the link now asks another source, or one may
    /// appear.
    [[nodiscard]] virtual bool distrust(ContentKey /*key*/) { return false; }

    /// Delivers the pieces that have arrived. Also does the link's own upkeep: call it often (a few
    /// hundred times a second) even without open requests.
    virtual void poll(PieceSink& sink) = 0;

    [[nodiscard]] virtual LinkState state() const = 0;

    /// Number of connections so far. When it changes, the present server knows none of the earlier
    /// requests.
    [[nodiscard]] virtual std::uint64_t session() const = 0;

    /// Payload bytes received, the link's keys and framing included.
    [[nodiscard]] virtual std::uint64_t bytes_received() const = 0;

    /// Requested pieces that are known to be damaged in their storage.
    [[nodiscard]] virtual std::uint64_t damaged() const { return 0; }
};

} // namespace tactus
