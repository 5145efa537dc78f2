// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/content_key.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace tactus
{

/// Receives the pieces that a link delivers. `bytes` are in coded form, unverified, and valid only
/// during the call. A base mesh arrives in parts (transport/part_intake.hpp); `key.number` is the
/// number of the part.
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
    server_gone, ///< No server has this model now, but one may return.
};

/// Source of one model's base mesh, index pages and chunks: a file, a server, or a stand-in for
/// tests. One thread, the transport thread; no call waits, except for a file's disk.
///
/// Pieces may be lost, repeated, reordered or damaged. The user of the link verifies them and
/// requests them again.
class ChunkLink
{
public:
    ChunkLink() = default;
    virtual ~ChunkLink() = default;
    ChunkLink(const ChunkLink&) = delete;
    ChunkLink& operator=(const ChunkLink&) = delete;
    ChunkLink(ChunkLink&&) = delete;
    ChunkLink& operator=(ChunkLink&&) = delete;

    /// Requests pieces of the model, highest priority first. Requests of a newer generation are
    /// answered before waiting ones of older generations.
    virtual void request(std::span<const ContentKey> keys, std::uint32_t generation) = 0;

    /// Reports a piece with a wrong hash, during its receive(); for a base mesh, after its last
    /// part. True if a further request may succeed, with another source or after one appears.
    [[nodiscard]] virtual bool distrust(ContentKey /*key*/) { return false; }

    /// Delivers the pieces that have arrived and maintains the connection. Call it a few hundred
    /// times a second, even without open requests.
    virtual void poll(PieceSink& sink) = 0;

    [[nodiscard]] virtual LinkState state() const = 0;

    /// Number of connections so far. After a change, repeat all open requests: the present server
    /// has not received them.
    [[nodiscard]] virtual std::uint64_t session() const = 0;

    /// Bytes of all pieces received, including the link's keys and framing.
    [[nodiscard]] virtual std::uint64_t bytes_received() const = 0;

    /// Number of requested pieces found damaged in storage.
    [[nodiscard]] virtual std::uint64_t damaged() const { return 0; }
};

} // namespace tactus
