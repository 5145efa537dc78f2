// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/system_call_trap.hpp"

#include "platform/machine/posix/posix_error.hpp"
#include "transport/base/refusal.hpp"

// The thread sanitizer delays handlers until the trapped call should have returned.
#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define TACTUS_PUTS_SIGNALS_OFF 1 // NOLINT(cppcoreguidelines-macro-usage): selects code.
#endif
#endif

#if defined(__linux__) && (defined(__x86_64__) || defined(__aarch64__)) &&                         \
    !defined(__SANITIZE_THREAD__) && !defined(TACTUS_PUTS_SIGNALS_OFF)
#define TACTUS_HAS_SYSTEM_CALL_TRAP 1 // NOLINT(cppcoreguidelines-macro-usage): selects code.
#else
#define TACTUS_HAS_SYSTEM_CALL_TRAP 0 // NOLINT(cppcoreguidelines-macro-usage): selects code.
#endif

#if TACTUS_HAS_SYSTEM_CALL_TRAP
#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <optional>
#include <pthread.h>
#include <string>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>
#endif

namespace tactus::system_call_trap
{

namespace
{

// The variables are constant-initialised and in the program's own static storage, so the handler's
// first access neither allocates nor calls. They are global, since a handler has no user argument.
// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables)
constinit thread_local TrappedCalls thread_calls{};
constinit thread_local bool thread_runs_a_frame = false;
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

} // namespace

void mark_frame(bool is_running) noexcept
{
    thread_runs_a_frame = is_running;
}

TrappedCalls of_this_thread() noexcept
{
    return thread_calls;
}

} // namespace tactus::system_call_trap

#if TACTUS_HAS_SYSTEM_CALL_TRAP

extern "C"
{
    /// Number and arguments of a call, in the order that tactus_make_call() reads them.
    struct TactusSystemCall
    {
        long number;
        long arguments[6]; // NOLINT(cppcoreguidelines-avoid-c-arrays): read by assembly.
    };

    /// Makes the call and returns the kernel's result: an error as its negative number.
    long tactus_make_call(const TactusSystemCall* call) noexcept;
    /// Address directly after the one instruction that the filter permits.
    extern const char tactus_behind_call; // NOLINT(readability-identifier-naming): a label.
}

#if defined(__x86_64__)
asm(R"(
    .text
    .p2align 4
    .globl tactus_make_call
    .hidden tactus_make_call
    .type tactus_make_call, @function
tactus_make_call:
    mov (%rdi), %rax
    mov 16(%rdi), %rsi
    mov 24(%rdi), %rdx
    mov 32(%rdi), %r10
    mov 40(%rdi), %r8
    mov 48(%rdi), %r9
    mov 8(%rdi), %rdi
    syscall
    .globl tactus_behind_call
    .hidden tactus_behind_call
tactus_behind_call:
    ret
    .size tactus_make_call, . - tactus_make_call
)");
#else
asm(R"(
    .text
    .p2align 4
    .globl tactus_make_call
    .hidden tactus_make_call
    .type tactus_make_call, %function
tactus_make_call:
    mov x9, x0
    ldr x8, [x9]
    ldp x0, x1, [x9, #8]
    ldp x2, x3, [x9, #24]
    ldp x4, x5, [x9, #40]
    svc #0
    .globl tactus_behind_call
    .hidden tactus_behind_call
tactus_behind_call:
    ret
    .size tactus_make_call, . - tactus_make_call
)");
#endif

namespace tactus::system_call_trap
{

namespace
{

#if defined(__x86_64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_X86_64;

TactusSystemCall call_of(const ucontext_t& context) noexcept
{
    const auto& r = context.uc_mcontext.gregs;
    return {r[REG_RAX], {r[REG_RDI], r[REG_RSI], r[REG_RDX], r[REG_R10], r[REG_R8], r[REG_R9]}};
}

void set_result(ucontext_t& context, long result) noexcept
{
    context.uc_mcontext.gregs[REG_RAX] = result;
}
#else
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_AARCH64;

TactusSystemCall call_of(const ucontext_t& context) noexcept
{
    const auto& r = context.uc_mcontext.regs;
    const auto at = [&r](std::size_t i) { return static_cast<long>(r[i]); };
    return {at(8), {at(0), at(1), at(2), at(3), at(4), at(5)}};
}

void set_result(ucontext_t& context, long result) noexcept
{
    context.uc_mcontext.regs[0] = static_cast<unsigned long long>(result);
}
#endif

/// Handles a trapped call on its thread, directly after the call. Registers and errno are left as
/// by the call itself.
void on_trapped_call(int /*signal*/, siginfo_t* info, void* raw_context) noexcept
{
    auto& context = *static_cast<ucontext_t*>(raw_context);
    const TactusSystemCall call = call_of(context);
    if (thread_runs_a_frame)
    {
        thread_calls.first_in_frame =
            thread_calls.in_frame == 0 ? call.number : thread_calls.first_in_frame;
        ++thread_calls.in_frame;
    }
    else
    {
        ++thread_calls.outside;
    }
    // A call by another architecture's interface can't be repeated here.
    const bool is_ours = info->si_arch == kArchitecture;
    set_result(context, is_ours ? tactus_make_call(&call) : -ENOSYS);
}

Refusal refusal(const char* what, int error)
{
    return {std::string("system calls can't be trapped: ") + what + " (" +
            posix::name_of_error(error) + ")"};
}

/// Sets the process's handler and this thread's mask: a blocked SIGSYS would end the process.
std::optional<Refusal> set_handler()
{
    struct sigaction action
    {
    };
    action.sa_sigaction = on_trapped_call;
    action.sa_flags = SA_SIGINFO;
    sigfillset(&action.sa_mask);
    if (sigaction(SIGSYS, &action, nullptr) != 0)
    {
        return refusal("SIGSYS can't be handled", errno);
    }
    sigset_t only;
    sigemptyset(&only);
    sigaddset(&only, SIGSYS);
    const int error = pthread_sigmask(SIG_UNBLOCK, &only, nullptr);
    return error == 0 ? std::nullopt : std::optional(refusal("SIGSYS stays blocked", error));
}

// The kernel's macros for filter programs contain C-style casts.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast"

int install_filter(std::uint64_t behind_call) noexcept
{
    const auto low = static_cast<std::uint32_t>(behind_call);
    const auto high = static_cast<std::uint32_t>(behind_call >> 32U);
    // The halves of the address are in the machine's order, little-endian on both.
    constexpr std::uint32_t kLow = offsetof(seccomp_data, instruction_pointer);
    constexpr std::uint32_t kHigh = kLow + 4;
    std::array<sock_filter, 10> filter{{
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, arch)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kArchitecture, 0, 6),
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, __NR_rt_sigreturn, 5, 0),
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kLow),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, low, 0, 2),
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kHigh),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, high, 1, 0),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
    }};
    const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
    // Without TSYNC the filter is for this thread only. SPEC_ALLOW avoids a slower thread.
    const long failed =
        // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the C library has no other.
        syscall(__NR_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_SPEC_ALLOW, &program);
    return failed == 0 ? 0 : errno;
}

#pragma GCC diagnostic pop

} // namespace

Result<Done, Refusal> set_on_this_thread()
{
    if (std::optional<Refusal> error = set_handler())
    {
        return std::move(*error);
    }
    // An unprivileged thread needs no_new_privs to install a filter; only this thread gets it.
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the C library has no other.
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0)
    {
        return refusal("no_new_privs can't be set", errno);
    }
    const auto behind_call = reinterpret_cast<std::uint64_t>(&tactus_behind_call);
    if (const int error = install_filter(behind_call); error != 0)
    {
        return refusal("the kernel accepts no seccomp filter", error);
    }
    return Done{};
}

} // namespace tactus::system_call_trap

#else

namespace tactus::system_call_trap
{

Result<Done, Refusal> set_on_this_thread()
{
    return Refusal{"system calls can't be trapped: this needs Linux on x86-64 or aarch64, and a "
                   "build without the thread sanitizer"};
}

} // namespace tactus::system_call_trap

#endif
