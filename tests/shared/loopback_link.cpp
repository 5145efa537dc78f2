// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/loopback_link.hpp"

#include "rt_core/base/assert.hpp"

#include <utility>

namespace tactus
{

LoopbackLink::LoopbackLink(ChunkLink& wrapped, const LoopbackFaults& faults)
    : wrapped_(wrapped), faults_(faults), random_(faults.seed)
{
    TACTUS_ASSERT(faults.delay_polls_min <= faults.delay_polls_max);
}

void LoopbackLink::request(std::span<const ContentKey> keys, std::uint32_t generation)
{
    if (state_ == LinkState::connected && !happens(faults_.loss))
    {
        wrapped_.request(keys, generation);
    }
}

void LoopbackLink::poll(PieceSink& sink)
{
    ++polls_;
    if (state_ == LinkState::connected)
    {
        wrapped_.poll(*this);
    }
    std::vector<InFlight> waiting;
    std::swap(waiting, in_flight_);
    for (InFlight& piece : waiting)
    {
        if (piece.due_poll > polls_)
        {
            in_flight_.push_back(std::move(piece));
            continue;
        }
        bytes_received_ += piece.bytes.size();
        sink.receive(piece.key, piece.bytes);
    }
}

void LoopbackLink::lose_server()
{
    state_ = LinkState::server_gone;
    in_flight_.clear();
}

void LoopbackLink::regain_server()
{
    state_ = LinkState::connected;
    ++session_;
}

void LoopbackLink::receive(ContentKey key, std::span<const std::byte> bytes)
{
    const ContentKey shown = happens(faults_.mix_ups) ? last_key_ : key;
    last_key_ = key;
    if (happens(faults_.loss))
    {
        return;
    }
    launch(shown, bytes);
    if (happens(faults_.duplicates))
    {
        launch(shown, bytes);
    }
}

void LoopbackLink::launch(ContentKey key, std::span<const std::byte> bytes)
{
    const std::uint64_t spread = faults_.delay_polls_max - faults_.delay_polls_min + 1;
    InFlight piece{key,
                   polls_ + faults_.delay_polls_min + next_random() % spread,
                   {bytes.begin(), bytes.end()}};
    if (happens(faults_.damage) && !piece.bytes.empty())
    {
        const std::uint64_t bit = next_random() % (8 * piece.bytes.size());
        piece.bytes[bit / 8] ^= std::byte{1} << (bit % 8);
    }
    in_flight_.push_back(std::move(piece));
}

/// SplitMix64: the same numbers on every machine.
std::uint64_t LoopbackLink::next_random() noexcept
{
    random_ += 0x9E37'79B9'7F4A'7C15U;
    std::uint64_t mixed = random_;
    mixed = (mixed ^ (mixed >> 30U)) * 0xBF58'476D'1CE4'E5B9U;
    mixed = (mixed ^ (mixed >> 27U)) * 0x94D0'49BB'1331'11EBU;
    return mixed ^ (mixed >> 31U);
}

bool LoopbackLink::happens(double share) noexcept
{
    return static_cast<double>(next_random() >> 11U) * 0x1p-53 < share;
}

} // namespace tactus
