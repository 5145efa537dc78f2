// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstdint>

/// Shows that a frame makes no system call. Once set, every call of the thread traps: the kernel
/// raises SIGSYS instead of serving it, and the handler counts the call, then makes it on the
/// thread's behalf.
///
/// The handler's own call must not trap. A seccomp filter can't read memory and so no flag, but it
/// sees the address of the calling instruction. It permits one instruction of the implementation,
/// and the return from a signal handler; all else traps.
///
/// The filter belongs to the calling thread and can't be removed; threads started from it later
/// inherit it. It costs each call about 3 us, so it is for tests. While it is set, a change of the
/// signal mask does not outlive the call that requested it, and SIGSYS must stay unblocked; both
/// hold up to the thread's end.
///
/// A clock that the kernel serves through the vDSO is read without a system call: such reads, those
/// of the stage hook for instance, neither trap nor count. On a machine whose clock source does not
/// allow it they are system calls, and count.
namespace tactus::system_call_trap
{

/// Calls that trapped on the calling thread.
struct TrappedCalls
{
    std::uint64_t in_frame{0}; ///< Calls while a frame was marked.
    /// Other calls. More than 0 in any loop that sleeps, if the trap is set.
    std::uint64_t outside{0};
    std::int64_t first_in_frame{-1}; ///< Number of the first call in a frame; -1: none.
};

/// Sets the trap on the calling thread permanently. Refused if the kernel has no seccomp filters,
/// and with `not_permitted` if this process may not use them. Only builds for Linux on x86-64 and
/// aarch64 without the thread sanitizer support it; others refuse it.
[[nodiscard]] Result<Done, Refusal> set_on_this_thread();

/// Marks or unmarks the calling thread as running a frame. About 1 ns; no other cost without a
/// trap.
void mark_frame(bool is_running) noexcept;

/// Counts of the calling thread. About 1 ns.
[[nodiscard]] TrappedCalls of_this_thread() noexcept;

} // namespace tactus::system_call_trap
