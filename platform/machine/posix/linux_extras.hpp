// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/thread_usage.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>

/// Calls that only Linux has, or that other POSIX systems have in another form. One of two sources
/// is built: linux_extras.cpp on Linux, elsewhere generic_extras.cpp, which does without them. A
/// port may add a third (docs/internals/porting.md).
namespace tactus::linux_extras
{

/// Pins the calling thread. Returns 0 or the errno of the refusal; EINVAL if this process may not
/// run on `cpu`, ENOTSUP if threads can't be pinned.
[[nodiscard]] int pin_calling_thread(int cpu) noexcept;

/// Keeps the calling thread, and threads that it starts later, off `cpu`. No effect if the process
/// has no other processor, or if its processors are unknown.
void keep_calling_thread_off(int cpu) noexcept;

/// Lets the calling thread use every processor of its process.
void let_calling_thread_use_all() noexcept;

/// A line that explains why a thread was not pinned to `cpu`, and lists the available processors.
[[nodiscard]] std::string explain_pin_refusal(int cpu);

/// Lowest processor other than `cpu` that this process may use; none if there is none or it is
/// unknown.
[[nodiscard]] std::optional<int> another_cpu(int cpu) noexcept;

/// A line that explains why SCHED_FIFO was refused and how to grant it.
[[nodiscard]] std::string explain_fifo_refusal(int priority, int error);

/// Checks after mlockall() that no limit prevents the locking of future memory. Maps more than the
/// process may lock, without access and so without pages, and unmaps it. Returns 0 if the system
/// allows this, otherwise the errno.
[[nodiscard]] int try_to_exceed_lock_limit() noexcept;

/// A line that explains why memory was not locked and how to grant it.
[[nodiscard]] std::string explain_lock_refusal(int error);

/// Reads faults and context switches of the calling thread, 0 if the system doesn't count them;
/// cpu_time is unchanged.
void read_fault_and_switch_counts(ThreadUsage& usage) noexcept;

/// Allows the system to back this memory with huge pages. `memory` starts on a page.
void ask_for_huge_pages(std::span<std::byte> memory) noexcept;

/// Fills `bytes`, 256 at most, with unpredictable bits. False if the system gives none.
[[nodiscard]] bool draw_random(std::span<std::byte> bytes) noexcept;

/// Keeps the processors of the whole machine from deep sleep during its life, if granted. That
/// costs power.
class AwakeProcessors
{
public:
    AwakeProcessors() noexcept;
    AwakeProcessors(const AwakeProcessors&) = delete;
    AwakeProcessors& operator=(const AwakeProcessors&) = delete;
    ~AwakeProcessors();

    [[nodiscard]] bool are_granted() const noexcept { return descriptor_ >= 0; }

private:
    int descriptor_{-1}; ///< Open file that holds the request; -1: not granted.
};

} // namespace tactus::linux_extras
