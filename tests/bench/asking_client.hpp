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

/// Client that requests chunks of a model in its own order, like a controller's transport without
/// the rest. Received chunks are counted, not decoded.
class AskingClient final : private PieceSink
{
public:
    /// Requests `rate_hz` chunks a second; 0: as fast as they arrive. The model must outlive the
    /// client.
    AskingClient(ServedModel& model, double rate_hz);

    /// Runs for `seconds` or until `stop` is set.
    void run(double seconds, const std::atomic<bool>& stop);

    /// Report:
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
