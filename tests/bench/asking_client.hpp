// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/served_model.hpp"
#include "transport/waiting_times.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

namespace tactus::bench
{

/// Asks for chunks of a model in an order of its own, as a controller's transport does, without the
/// rest of a controller. What comes is counted and not looked at.
class AskingClient final : private PieceSink
{
public:
    /// `rate_hz` chunks a second; 0: as fast as they come. The model must outlive the client.
    AskingClient(ServedModel& model, double rate_hz);

    /// Until then, or until it is told to stop.
    void run(double seconds, const std::atomic<bool>& stop);

    /// {"pieces","bytes","link_bytes","seconds","asked","asked_again","p50_ms","p99_ms","max_ms"}.
    [[nodiscard]] std::string to_json() const;

private:
    using Clock = std::chrono::steady_clock;
    struct Open
    {
        Clock::time_point first;
        Clock::time_point last;
    };

    void ask(double elapsed_s);
    void ask_again();
    void send();
    void receive(ContentKey key, std::span<const std::byte> bytes) override;

    ChunkLink& link_;
    std::uint32_t chunks_;
    double rate_hz_;
    std::unordered_map<std::uint32_t, Open> open_;
    std::vector<ContentKey> batch_;
    Clock::time_point looked_{};
    WaitingTimes times_;
    std::uint64_t bytes_{0};
    std::uint64_t asked_{0};
    std::uint64_t asked_again_{0};
    std::uint32_t generation_{0};
    double seconds_{0.0};
};

} // namespace tactus::bench
