// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/spm/content_key.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace tactus::dds
{

/// A piece of one of the models of a server.
struct ServerPiece
{
    std::uint32_t model{0}; ///< Number of the model on the server.
    ContentKey key;

    constexpr bool operator==(const ServerPiece&) const noexcept = default;
};

/// Waiting requests of one controller, on the server: newest generation first, then in the order of
/// arrival; each piece once. If the queue is full, its last request is dropped.
///
/// A table of fixed size with a list in that order and a hash table of the pieces. The hash has a
/// random factor, so that no controller can choose pieces that collide. Cost does not depend on the
/// number of requests, except for a piece of another generation than the piece added before: its
/// place is searched from the front.
class RequestQueue
{
public:
    explicit RequestQueue(std::size_t capacity)
        : slots_(capacity + 1)
        , chains_(std::bit_ceil(capacity + 1), kNone)
        , end_(static_cast<Index>(capacity))
    {
        TACTUS_ASSERT(capacity > 0);
        TACTUS_ASSERT(capacity < kNone);
        std::random_device random;
        factor_ = (std::uint64_t{random()} << 32U) | random() | 1U;
        slots_[end_].next = slots_[end_].previous = end_;
        for (Index slot = 0; slot < end_; ++slot)
        {
            slots_[slot].next = free_;
            free_ = slot;
        }
    }

    /// Adds a request; moves it if the piece is known. Generations increase and may wrap.
    void add(const ServerPiece& piece, std::uint32_t generation)
    {
        if (const Index known = find(piece); known != kNone)
        {
            take_out(known);
        }
        const Index before = place_before(generation);
        if (free_ == kNone)
        {
            ++forgotten_;
            if (before == slots_[end_].previous)
            {
                return; // The new request would be the last one.
            }
            take_out(slots_[end_].previous);
        }
        put_after(before, piece, generation);
    }

    [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    [[nodiscard]] std::uint64_t forgotten() const noexcept { return forgotten_; }
    /// Request of highest priority; the queue must not be empty.
    [[nodiscard]] const ServerPiece& front() const noexcept
    {
        return slots_[slots_[end_].next].piece;
    }
    void pop_front() noexcept { take_out(slots_[end_].next); }

private:
    using Index = std::uint16_t;
    static constexpr Index kNone = UINT16_MAX;

    struct Slot
    {
        ServerPiece piece;
        std::uint32_t generation{0};
        Index next{0}; ///< Next slot in the queue, or in the list of free slots.
        Index previous{0};
        Index chained{kNone}; ///< Next slot with the same hash.
    };

    [[nodiscard]] Index& chain_of(const ServerPiece& piece) noexcept
    {
        const std::uint64_t name =
            (std::uint64_t{piece.model} << 40U) ^
            (std::uint64_t{static_cast<std::uint8_t>(piece.key.kind)} << 32U) ^ piece.key.number;
        return chains_[(name * factor_) >>
                       (64U - static_cast<unsigned>(std::countr_zero(chains_.size())))];
    }

    [[nodiscard]] Index find(const ServerPiece& piece) noexcept
    {
        Index slot = chain_of(piece);
        while (slot != kNone && slots_[slot].piece != piece)
        {
            slot = slots_[slot].chained;
        }
        return slot;
    }

    /// Last slot of the same or a newer generation; `end_`, which precedes the first slot, if there
    /// is none.
    [[nodiscard]] Index place_before(std::uint32_t generation) const noexcept
    {
        const auto is_older = [&](Index slot) {
            return slot == end_ ||
                   static_cast<std::int32_t>(slots_[slot].generation - generation) < 0;
        };
        Index before = end_;
        if (last_ != end_ && slots_[last_].generation == generation)
        {
            before = last_; // Usual case.
        }
        while (!is_older(slots_[before].next))
        {
            before = slots_[before].next;
        }
        return before;
    }

    void put_after(Index before, const ServerPiece& piece, std::uint32_t generation) noexcept
    {
        const Index slot = free_;
        free_ = slots_[slot].next;
        Index& chain = chain_of(piece);
        slots_[slot] = {piece, generation, slots_[before].next, before, chain};
        chain = slot;
        slots_[slots_[slot].next].previous = slot;
        slots_[before].next = slot;
        last_ = slot;
        ++size_;
    }

    void take_out(Index slot) noexcept
    {
        Index* chain = &chain_of(slots_[slot].piece);
        while (*chain != slot)
        {
            chain = &slots_[*chain].chained;
        }
        *chain = slots_[slot].chained;
        slots_[slots_[slot].previous].next = slots_[slot].next;
        slots_[slots_[slot].next].previous = slots_[slot].previous;
        last_ = last_ == slot ? end_ : last_;
        slots_[slot].next = free_;
        free_ = slot;
        --size_;
    }

    std::vector<Slot> slots_; ///< Slots of requests, then one slot for the list's end.
    std::vector<Index> chains_;
    std::uint64_t factor_{1};
    Index end_;
    Index free_{kNone};
    Index last_{end_}; ///< Slot added last; `end_` if it has been taken out.
    std::size_t size_{0};
    std::uint64_t forgotten_{0};
};

} // namespace tactus::dds
