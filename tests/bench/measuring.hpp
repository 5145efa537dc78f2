// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/allocation_counter.hpp"
#include "rt_core/records/frame_input.hpp"

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <malloc.h>
#include <numeric>
#include <optional>
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

/// Heap calls of a function.
template <typename Function>
std::uint64_t allocations_of(const Function& function)
{
    const std::uint64_t before = allocation_counter::of_this_thread().allocations;
    allocation_counter::mark_this_thread(true);
    function();
    allocation_counter::mark_this_thread(false);
    return allocation_counter::of_this_thread().allocations - before;
}

/// Count of allocations_of(); empty if allocations are not counted.
[[nodiscard]] inline std::optional<std::uint64_t> counted_if_available(std::uint64_t allocations)
{
    return allocation_counter::available() ? std::optional(allocations) : std::nullopt;
}

/// Bytes in use on the heap, with its own bookkeeping: of the process's main thread and of separate
/// mappings. Always 0 under a sanitizer.
[[nodiscard]] inline std::size_t heap_bytes()
{
    const struct mallinfo2 now = ::mallinfo2();
    return now.uordblks + now.hblkhd;
}

/// Measures the time at the end of each stage.
class StageTimer
{
public:
    void begin() { last_ = BenchClock::now(); }
    [[nodiscard]] StageMark mark() { return {&end_stage, this}; }
    [[nodiscard]] double us(Stage stage) const { return us_[static_cast<std::size_t>(stage)]; }
    [[nodiscard]] double sum_us() const { return std::accumulate(us_.begin(), us_.end(), 0.0); }

private:
    // Reads a clock, nothing else.
    TACTUS_TRUSTED_BEGIN
    static void end_stage(void* context, Stage stage) noexcept TACTUS_NONBLOCKING
    {
        StageTimer& timer = *static_cast<StageTimer*>(context);
        const BenchClock::time_point now = BenchClock::now();
        timer.us_[static_cast<std::size_t>(stage)] = microseconds(timer.last_, now);
        timer.last_ = now;
    }
    TACTUS_TRUSTED_END

    std::array<double, kStages> us_{};
    BenchClock::time_point last_;
};

/// q-quantile (0 .. 1) by nearest rank, always one of the values. NaN without values.
[[nodiscard]] double quantile(std::vector<double> values, double q);

struct Spread
{
    double p50{0.0};
    double p99{0.0};
    double max{0.0};
};
[[nodiscard]] Spread spread_of(const std::vector<double>& values);

/// Least time of each frame over repeated replays. This removes delays by the machine's scheduler;
/// the greatest single time shows their size.
class LeastTimes
{
public:
    explicit LeastTimes(std::size_t frames = 0);

    void keep(std::size_t frame, double time);

    [[nodiscard]] const std::vector<double>& least() const { return least_; }
    [[nodiscard]] double raw_max() const { return raw_max_; }

private:
    std::vector<double> least_; ///< Infinity before the first replay.
    double raw_max_{0.0};
};

/// Values of the chosen frames.
[[nodiscard]] std::vector<double> chosen(const std::vector<double>& values,
                                         const std::vector<bool>& choice);

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
