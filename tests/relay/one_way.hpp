// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/time.hpp"
#include "tests/relay/frame_fates.hpp"
#include "tests/relay/relay_command.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tactus::relay
{

/// Counts since the start: frames + duplicated = delivered + lost + cut + dropped_full + frames in
/// transit.
struct OneWayCounts
{
    std::uint64_t frames{0}; ///< Frames from the sender, independent of their fate.
    std::uint64_t bytes{0};  ///< Bytes of whole frames, from the Ethernet header on.
    std::uint64_t udp_datagrams{0};
    std::uint64_t udp_payload_bytes{0};
    std::uint64_t delivered{0};  ///< Copies delivered.
    std::uint64_t lost{0};       ///< Frames lost by `LinkCondition::loss`.
    std::uint64_t duplicated{0}; ///< Frames duplicated by `LinkCondition::duplicates`.
    std::uint64_t cut{0}; ///< Frames that arrived, or were in transit, while the link was cut.
    std::uint64_t dropped_full{0}; ///< Copies that exceeded the capacity.
};

/// One direction of the link, in which frames wait until they are due. It has no clock and no
/// device. One thread.
class OneWay
{
public:
    /// Capacity: one second of a link of 500 Mbit/s.
    static constexpr std::size_t kBytesMax = std::size_t{64} << 20U;

    explicit OneWay(std::uint64_t seed, std::size_t bytes_max = kBytesMax)
        : fates_(seed), bytes_max_(bytes_max)
    {
    }

    /// Takes a frame sent at `now`. O(log n) of the frames in transit.
    void take(std::span<const std::byte> frame, const LinkCondition& condition, MonotonicTime now);

    /// Time at which the next frame is due; empty if none is in transit.
    [[nodiscard]] std::optional<MonotonicTime> next_due() const;

    /// Frame that is due first, if not later than `now`; the first one of several with the same
    /// time. Each copy is returned once.
    [[nodiscard]] std::optional<std::vector<std::byte>> take_due(MonotonicTime now);

    /// Blocks the link from now on and drops all frames in transit.
    void cut();
    void restore() { is_cut_ = false; }

    [[nodiscard]] const OneWayCounts& counts() const { return counts_; }

private:
    struct Waiting
    {
        MonotonicTime due;
        std::uint64_t order{0};
        std::vector<std::byte> frame;
    };
    static bool is_later(const Waiting& a, const Waiting& b);

    void enqueue(std::span<const std::byte> frame, MonotonicTime due);

    FrameFates fates_;
    std::size_t bytes_max_;
    std::size_t bytes_waiting_{0};
    std::uint64_t next_order_{0};
    std::vector<Waiting> heap_; ///< Heap with the next due frame in front.
    bool is_cut_{false};
    OneWayCounts counts_;
};

} // namespace tactus::relay
