// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/thread_usage.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>

/// The only calls that Linux has and other POSIX systems do not, or have in another form. A port
/// replaces linux_extras.cpp and nothing else.
namespace tactus::linux_extras
{

/// Returns 0 or the errno of the refusal; EINVAL when this process may not run on `cpu`.
[[nodiscard]] int pin_calling_thread(int cpu) noexcept;

/// The processors this process may use, as "0-1,3"; for messages.
[[nodiscard]] std::string allowed_cpus();

/// The lowest processor other than `cpu` that this process may use; none when there is none.
[[nodiscard]] std::optional<int> another_cpu(int cpu) noexcept;

/// The line that tells why SCHED_FIFO was refused and what would grant it.
[[nodiscard]] std::string explain_fifo_refusal(int priority, int error);

/// Faults and context switches of the calling thread; leaves cpu_time alone.
void read_fault_and_switch_counts(ThreadUsage& usage) noexcept;

/// Lets the system back this memory with huge pages; it may as well not. `memory` starts on a page.
void ask_for_huge_pages(std::span<std::byte> memory) noexcept;

} // namespace tactus::linux_extras
