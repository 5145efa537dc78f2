// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus
{

/// Settings of a real-time thread.
struct RtThreadOptions
{
    static constexpr int kPriorityMin = 1;
    /// Highest priority, so that 99 is left for a supervisor one above.
    static constexpr int kPriorityMax = 98;
    static constexpr std::size_t kStackBytesMin = 64 * 1024;
    static constexpr std::size_t kStackBytesMax = 64 * 1024 * 1024;

    int priority{80};       ///< Priority in SCHED_FIFO, in [kPriorityMin, kPriorityMax].
    std::optional<int> cpu; ///< Processor to pin to; none leaves it to the system.
    /// Stack, touched before the body runs; rounded up to pages.
    std::size_t stack_bytes{1024 * 1024};
    bool is_realtime{true};    ///< False: uses the policy of ordinary threads.
    bool lock_memory{true};    ///< Locks all memory of the process, present and future.
    bool allow_no_rt{false};   ///< Runs with the granted rights and lists the refused ones.
    bool is_supervisor{false}; ///< True: a priority one above kPriorityMax is in range, too.
    /// Keeps all processors of the machine from deep sleep until the thread is joined, if granted
    /// (on Linux by /dev/cpu_dma_latency; root by default). Waking from a deep sleep may take
    /// longer than the loop can wait. The option costs power.
    bool processors_awake{true};
};

/// Rights that the thread was granted.
struct RtThreadReport
{
    bool fifo{false};             ///< True if it runs with SCHED_FIFO at the requested priority.
    bool memory_locked{false};    ///< True if memory was locked on request.
    bool pinned{false};           ///< True if it was pinned on request.
    bool processors_awake{false}; ///< True if that was requested and granted.
    bool float_control_was_default{true}; ///< False: reset_float_control() had to correct it.
    std::vector<std::string> refused;     ///< Refusals, one line each with its remedy.
};

/// A thread for the haptic loop or its supervisor: SCHED_FIFO, pinned, on a stack that is already
/// in memory, with all signals blocked (they belong to the main thread) and the default
/// floating-point control. Joined on destruction.
///
/// One ordinary thread starts, joins and destroys it.
///
/// Locking memory concerns the whole process and stays in force afterwards. Threads started from
/// the body inherit its policy and processor: start others elsewhere.
class RtThread
{
public:
    /// Starts the thread, waits until it is set up, then lets `body` run. A lack of rights is
    /// refused with one line for each missing right, and no body runs; with `allow_no_rt` the body
    /// runs and report() has those lines. `body` must not throw. A value out of range or a
    /// processor that this process may not use is refused as usage (`Refusal::is_usage`) in both
    /// cases. A lack of memory or threads is refused as a failure.
    [[nodiscard]] static Result<RtThread, Refusal> start(const RtThreadOptions& options,
                                                         std::function<void()> body);

    RtThread(RtThread&&) noexcept;
    RtThread& operator=(RtThread&&) noexcept;
    ~RtThread();

    /// Waits until the body has returned. No effect the second time.
    void join() noexcept;

    /// Report, valid during the thread object's life; any thread.
    [[nodiscard]] const RtThreadReport& report() const noexcept;

private:
    struct Running;
    explicit RtThread(std::unique_ptr<Running> running) noexcept;

    std::unique_ptr<Running> running_;
};

/// Lines with which RtThread::start() would report refused rights on this machine; empty if all are
/// granted. Starts a short-lived thread with these options, then unlocks all memory of the process.
/// So call it before the first start().
[[nodiscard]] Result<std::vector<std::string>, Refusal>
probe_realtime(const RtThreadOptions& options);

} // namespace tactus
