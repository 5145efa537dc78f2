// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstdint>

/// Proof that a frame makes no system call. Once set, every call of the thread traps: the kernel
/// raises SIGSYS instead of serving it, and the handler counts the call, then makes it on the
/// thread's behalf.
///
/// How the handler's own call gets through: the thread's seccomp filter sees no memory and so no
/// flag, but it does see the address of the instruction that calls. It lets through one single
/// instruction of this file, and the return from a signal handler; all else traps.
///
/// The filter belongs to the calling thread alone and can't be taken away again; threads started
/// from it later inherit it. It costs each call some 3 us, so it is for tests. While it is set,
/// a change of the signal mask does not outlive the call that asked for it, and SIGSYS must stay
/// unblocked; both hold up to the thread's end.
///
/// A clock that the kernel serves through the vDSO is read without a system call: such reads,
/// those of the stage hook for instance, neither trap nor count. On a machine whose clock source
/// does not allow it they are system calls, and count.
namespace tactus::system_call_trap
{

/// Calls that trapped on the calling thread.
struct TrappedCalls
{
    std::uint64_t in_frame{0}; ///< While a frame was marked.
    std::uint64_t outside{0};  ///< More than 0 in any loop that sleeps, or the trap is not there.
    std::int64_t first_in_frame{-1}; ///< Number of the first one in a frame; -1: none.
};

/// Sets the trap on the calling thread, for good. Refused where the kernel has no seccomp filters,
/// and with `not_permitted` where this process may not use them. Only Linux on x86-64 and aarch64
/// can do it, without the thread sanitizer; any other build refuses with one line that says so.
[[nodiscard]] Result<Done, Refusal> set_on_this_thread();

/// Tells that a frame runs on the calling thread from here on, or no longer. About 1 ns; costs
/// nothing else when there is no trap.
void mark_frame(bool is_running) noexcept;

/// About 1 ns.
[[nodiscard]] TrappedCalls of_this_thread() noexcept;

} // namespace tactus::system_call_trap
