// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

namespace tactus::dds
{

/// Rate limit for an action with a cost that other programs on the domain can trigger. The first
/// action is immediate, the next one a second later; each further wait doubles, up to a minute.
class Backoff
{
public:
    using Clock = std::chrono::steady_clock;

    [[nodiscard]] bool is_due(Clock::time_point now) const noexcept { return now >= next_; }
    void begin(Clock::time_point now) noexcept
    {
        wait_ = std::clamp<Clock::duration>(2 * wait_, std::chrono::seconds(1),
                                            std::chrono::minutes(1));
        next_ = now + wait_;
    }

private:
    Clock::time_point next_{};
    Clock::duration wait_{};
};

/// Detects handshakes of DDS Security that never end, a fault of Cyclone DDS (its issue 1895). If
/// only one side loses the lease of the other, that side begins a handshake, and the other side,
/// still connected, does not answer. Remedy: this process is silent until its lease ends on the
/// other side too; both then begin again.
class HandshakeWatch
{
public:
    using Clock = std::chrono::steady_clock;
    /// Time without a connection after which a silence is due; handshakes take less than a second.
    static constexpr std::chrono::seconds kPatience{5};
    /// Length of the first silence. Each further one is longer by as much, up to the largest, which
    /// exceeds Cyclone's default lease of 10 s.
    static constexpr std::chrono::seconds kSilence{3};
    static constexpr std::chrono::seconds kLongestSilence{12};

    /// Takes the present state: `is_connected`, a server is connected; `is_discovered`, a server
    /// that was connected before is present, but none is connected. Returns the length of a silence
    /// that is due now. The patience begins after a silence: the end of an earlier silence would
    /// end a later one too. The pauses between their starts double up to a minute.
    [[nodiscard]] std::optional<std::chrono::seconds> step(Clock::time_point now, bool is_connected,
                                                           bool is_discovered) noexcept
    {
        if (is_connected)
        {
            *this = {};
        }
        if (!is_discovered || now < silent_until_)
        {
            since_.reset();
            return std::nullopt;
        }
        since_ = since_.value_or(now);
        if (now - *since_ < kPatience || !pause_.is_due(now))
        {
            return std::nullopt;
        }
        since_.reset();
        silence_ = std::min(silence_ + kSilence, kLongestSilence);
        silent_until_ = now + silence_;
        pause_.begin(now);
        return silence_;
    }

private:
    std::optional<Clock::time_point> since_; ///< Start of the present state without a connection.
    Clock::time_point silent_until_{};       ///< End of the last silence.
    std::chrono::seconds silence_{0};        ///< Length of the last silence.
    Backoff pause_;
};

} // namespace tactus::dds
