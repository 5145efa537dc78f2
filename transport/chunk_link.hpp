// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/content_key.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace tactus
{

/// Takes what a link delivers. The bytes are the piece's coded form, not verified, and valid only
/// during the call. Of a base mesh they are one part (transport/piece_parts.hpp), which is the
/// key's number.
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
    host_gone, ///< Nobody serves this model at present; it may come back.
};

/// Where one model's base mesh, index pages and chunks come from: a local file, a host on the
/// network, or a stand-in for one. Used by one thread, the transport thread; no call waits but for
/// a file's disk.
///
/// A link may lose, repeat, reorder and damage: the courier verifies and asks again.
class ChunkLink
{
public:
    ChunkLink() = default;
    virtual ~ChunkLink() = default;
    ChunkLink(const ChunkLink&) = delete;
    ChunkLink& operator=(const ChunkLink&) = delete;
    ChunkLink(ChunkLink&&) = delete;
    ChunkLink& operator=(ChunkLink&&) = delete;

    /// Asks for pieces that the model has, most urgent first. A newer generation goes before what
    /// is still waiting.
    virtual void request(std::span<const ContentKey> keys, std::uint32_t generation) = 0;

    /// Called in receive(), or after it for a base mesh that is whole: what came hasn't the hash
    /// that it should have. Whether it is worth while to ask again: another source is asked from
    /// now on, or may come.
    [[nodiscard]] virtual bool distrust(ContentKey /*key*/) { return false; }

    /// Hands over what has come in. Also the place for the link's own upkeep: call it often (a few
    /// hundred times a second) even when nothing was asked for.
    virtual void poll(PieceSink& sink) = 0;

    [[nodiscard]] virtual LinkState state() const = 0;

    /// Counts connections: when it changes, whoever serves now knows of no earlier request.
    [[nodiscard]] virtual std::uint64_t session() const = 0;

    /// Payload bytes that came in, keys and framing of the link included.
    [[nodiscard]] virtual std::uint64_t bytes_received() const = 0;

    /// Pieces that were asked for and that it knows to be damaged where they lie.
    [[nodiscard]] virtual std::uint64_t damaged() const { return 0; }
};

} // namespace tactus
