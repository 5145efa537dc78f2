// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <chrono>
#include <cstddef>
#include <sched.h>
#include <vector>

namespace tactus::bench
{

/// Clock of every time in a suite, ours and the peers'.
using BenchClock = std::chrono::steady_clock;

[[nodiscard]] inline double microseconds(BenchClock::time_point from, BenchClock::time_point to)
{
    return std::chrono::duration<double, std::micro>(to - from).count();
}

[[nodiscard]] inline double seconds(BenchClock::time_point from, BenchClock::time_point to)
{
    return std::chrono::duration<double>(to - from).count();
}

/// Difference of two consecutive clock readings in microseconds, contained in every time below.
[[nodiscard]] double clock_cost_us();

/// Keeps the calling thread on one core for its lifetime.
class PinnedCore
{
public:
    /// Pins to `core`; -1: the last one that the thread may use. core() is -1 if the system
    /// refuses.
    explicit PinnedCore(int core);
    PinnedCore(const PinnedCore&) = delete;
    PinnedCore& operator=(const PinnedCore&) = delete;
    ~PinnedCore();

    [[nodiscard]] int core() const { return core_; }

private:
    cpu_set_t before_{};
    int core_{-1};
};

/// True if the calling thread may run on this core.
[[nodiscard]] bool may_use_core(int core);

/// Evicts the caches by writing one word of each line of 64 MB: more than a core's own caches hold,
/// code included, and more than the rest of a 1 ms period can touch. A larger shared last-level
/// cache keeps a part. About 5 ms a call.
class CacheEvictor
{
public:
    void evict();

private:
    std::vector<unsigned char> bytes_ = std::vector<unsigned char>(std::size_t{64} << 20U);
};

} // namespace tactus::bench
