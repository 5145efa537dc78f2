// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/time.hpp"

#include <cstdint>

namespace tactus
{

/// The system's counts for one thread since its start; the difference of two readings judges a
/// cycle. A clean cycle of the haptic loop has no fault, and no switch except for its own sleep; an
/// involuntary switch is the machine's doing. If the system does not count them for a thread
/// (docs/internals/porting.md), faults and switches stay 0.
struct ThreadUsage
{
    std::int64_t minor_faults{0}; ///< Pages mapped without reading a disk.
    std::int64_t major_faults{0}; ///< Pages read from a disk.
    std::int64_t voluntary_switches{0};
    std::int64_t involuntary_switches{0};
    Duration cpu_time; ///< Processor time, including interrupts served meanwhile.
};

[[nodiscard]] constexpr ThreadUsage operator-(const ThreadUsage& a, const ThreadUsage& b) noexcept
{
    return {a.minor_faults - b.minor_faults, a.major_faults - b.major_faults,
            a.voluntary_switches - b.voluntary_switches,
            a.involuntary_switches - b.involuntary_switches, a.cpu_time - b.cpu_time};
}

/// Usage of the calling thread. Two system calls that never block, about 0.6 us together; call once
/// a cycle, outside the frame.
[[nodiscard]] ThreadUsage read_thread_usage() noexcept;

/// ThreadUsage::cpu_time alone, at one system call.
[[nodiscard]] Duration read_thread_cpu_time() noexcept;

/// Blocks SIGCONT, so that the continuation of a stopped process stays pending until
/// take_process_stop() takes it. Call on the main thread before it starts others, which inherit the
/// signal mask.
///
/// A stopped process is continued by SIGCONT alone, blocked or not, and the system makes the signal
/// pending before any thread runs again. So a thread that sees its own delay also sees the signal.
void watch_process_stops() noexcept;

/// True if the process was stopped from outside and continued since the last call; false without
/// watch_process_stops(). Two system calls at most, neither of which blocks.
[[nodiscard]] bool take_process_stop() noexcept;

} // namespace tactus
