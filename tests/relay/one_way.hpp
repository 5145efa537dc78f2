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

/// Since the start. Of all frames that came, frames + duplicated = delivered + lost + cut +
/// dropped_full + those under way.
struct OneWayCounts
{
    std::uint64_t frames{0}; ///< That the sender gave, whatever became of them; so the next three.
    std::uint64_t bytes{0};  ///< Of whole frames, from the Ethernet header on.
    std::uint64_t udp_datagrams{0};
    std::uint64_t udp_payload_bytes{0};
    std::uint64_t delivered{0};    ///< Each copy.
    std::uint64_t lost{0};         ///< By `LinkCondition::loss`.
    std::uint64_t duplicated{0};   ///< By `LinkCondition::duplicates`.
    std::uint64_t cut{0};          ///< That came, or were under way, while nothing passed.
    std::uint64_t dropped_full{0}; ///< Copies that found no room.
};

/// One direction of the link: frames wait in it until they are due. Knows no clock and no device.
/// One thread.
class OneWay
{
public:
    /// A second's worth of a link of 500 Mbit/s.
    static constexpr std::size_t kBytesMax = std::size_t{64} << 20U;

    explicit OneWay(std::uint64_t seed, std::size_t bytes_max = kBytesMax)
        : fates_(seed), bytes_max_(bytes_max)
    {
    }

    /// A frame that was sent at `now`. O(log n) of the frames under way.
    void take(std::span<const std::byte> frame, const LinkCondition& condition, MonotonicTime now);

    /// When the next frame is due; none when nothing is under way.
    [[nodiscard]] std::optional<MonotonicTime> next_due() const;

    /// The frame that is due first, when that is not later than `now`; of several with the same
    /// time the one that came first. Each copy comes out once.
    [[nodiscard]] std::optional<std::vector<std::byte>> take_due(MonotonicTime now);

    /// Nothing passes from now on, and what is under way is gone.
    void cut();
    void mend() { is_cut_ = false; }

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
    std::vector<Waiting> heap_; ///< The next one that is due is in front.
    bool is_cut_{false};
    OneWayCounts counts_;
};

} // namespace tactus::relay
