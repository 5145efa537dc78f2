// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/time.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tactus::relay
{

/// Content of an Ethernet frame by its headers.
struct FrameContent
{
    bool is_arp{false};
    /// Datagrams: 1 for a whole one and for the first fragment of one.
    std::uint32_t udp_datagrams{0};
    std::uint32_t udp_payload_bytes{0}; ///< Bytes without the eight bytes of UDP's header.
};

/// Reads Ethernet, IPv4 and UDP headers. A datagram in IP fragments is counted once, with its first
/// one, and its payload in each. Truncated or contradictory headers count as no UDP.
[[nodiscard]] FrameContent content_of(std::span<const std::byte> frame);

inline constexpr double kDelayMax_ms = 10'000.0;

struct LinkCondition
{
    double delay_ms{0.0}; ///< Delay of every frame, one way, 0 .. kDelayMax_ms.
    /// Additional delay, uniform from 0 to this; frames overtake each other.
    double jitter_ms{0.0};
    double loss{0.0};       ///< Share of the frames that are lost, 0 .. 1.
    double duplicates{0.0}; ///< Share of the arriving frames that are duplicated, 0 .. 1.
};

/// Cut of one or both directions.
struct Cut
{
    bool to_controller{true};
    bool to_server{true};
};
struct Restore
{
};
struct Count
{
};
/// Change of one figure of the condition.
struct Set
{
    double LinkCondition::*figure;
    double value;
};

/// Command to a running relay.
using Command = std::variant<Cut, Restore, Count, Set>;

/// Parses a line: "cut", "cut to-controller", "cut to-server", "restore", "count", or "set" with
/// "delay-ms", "jitter-ms", "loss" or "duplicates" and a number in its range. Empty for any other.
[[nodiscard]] std::optional<Command> parse_command(std::string_view line);

/// Allowed forms, for the refusal of other commands.
[[nodiscard]] std::string command_forms();

struct FrameFate
{
    std::size_t copies{0}; ///< Copies that arrive: 0 if it is lost, 2 if it is duplicated.
    std::array<Duration, 2> delays{};
};

/// Fates of the frames of one direction. That of frame n is a function of seed, n and condition
/// alone, independent of other frames and their times. A run with the same frames thus repeats, and
/// one with a larger loss also loses the frames of the smaller one.
class FrameFates
{
public:
    explicit FrameFates(std::uint64_t seed) : seed_(seed) {}

    /// Fate of the next frame. One that must arrive is neither lost nor duplicated, but delayed.
    [[nodiscard]] FrameFate next(const LinkCondition& condition, bool must_arrive);

private:
    std::uint64_t seed_;
    std::uint64_t frame_{0};
};

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
