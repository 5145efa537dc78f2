// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/thread_usage.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>

/// The only calls that Linux has and other POSIX systems do not, or have in another form. One
/// source of two is built: linux_extras.cpp on Linux, generic_extras.cpp, which can do none of it
/// and says so, everywhere else. A port may bring a third (docs/internals/porting.md).
namespace tactus::linux_extras
{

/// Returns 0 or the errno of the refusal; EINVAL when this process may not run on `cpu`, ENOTSUP
/// where threads can't be pinned.
[[nodiscard]] int pin_calling_thread(int cpu) noexcept;

/// Keeps the calling thread, and with it those that it starts, off `cpu` where there is another
/// processor for them; where not, and where nobody can say, nothing changes.
void keep_calling_thread_off(int cpu) noexcept;

/// Lets the calling thread use every processor that its process is given.
void let_calling_thread_use_all() noexcept;

/// The line that tells why a thread was not pinned to `cpu`, and which processors there are.
[[nodiscard]] std::string explain_pin_refusal(int cpu);

/// The lowest processor other than `cpu` that this process may use; none when there is none or
/// nobody knows.
[[nodiscard]] std::optional<int> another_cpu(int cpu) noexcept;

/// The line that tells why SCHED_FIFO was refused and what would grant it.
[[nodiscard]] std::string explain_fifo_refusal(int priority, int error);

/// With all memory locked, also what will be mapped later: maps more than the process may lock,
/// without access and so without pages, and unmaps it. Returns 0 when nothing limits it, or the
/// errno.
[[nodiscard]] int try_to_exceed_lock_limit() noexcept;

/// The line that tells why memory was not locked and what would grant it.
[[nodiscard]] std::string explain_lock_refusal(int error);

/// Faults and context switches of the calling thread, which stay 0 where nobody counts them;
/// leaves cpu_time alone.
void read_fault_and_switch_counts(ThreadUsage& usage) noexcept;

/// Lets the system back this memory with huge pages; it may as well not. `memory` starts on a page.
void ask_for_huge_pages(std::span<std::byte> memory) noexcept;

/// Fills `bytes`, 256 at most, with what nobody outside can know. False when the system gives none.
[[nodiscard]] bool draw_random(std::span<std::byte> bytes) noexcept;

/// While one lives no processor falls into a sleep that takes time to wake from, where that is
/// granted. It costs power on the whole machine.
class AwakeProcessors
{
public:
    AwakeProcessors() noexcept;
    AwakeProcessors(const AwakeProcessors&) = delete;
    AwakeProcessors& operator=(const AwakeProcessors&) = delete;
    ~AwakeProcessors();

    [[nodiscard]] bool are_granted() const noexcept { return descriptor_ >= 0; }

private:
    int descriptor_{-1}; ///< The wish holds while it is open.
};

} // namespace tactus::linux_extras
