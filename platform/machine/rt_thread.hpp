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

/// What a real-time thread asks of the machine.
struct RtThreadOptions
{
    static constexpr int kPriorityMin = 1;
    static constexpr int kPriorityMax = 98; ///< 99 is left for a supervisor one above.
    static constexpr std::size_t kStackBytesMin = 64 * 1024;
    static constexpr std::size_t kStackBytesMax = 64 * 1024 * 1024;

    int priority{80};                     ///< Of SCHED_FIFO, in [kPriorityMin, kPriorityMax].
    std::optional<int> cpu;               ///< Pin to this processor; none leaves it to the system.
    std::size_t stack_bytes{1024 * 1024}; ///< Touched before the body runs; rounded up to pages.
    bool is_realtime{true};               ///< False: with the policy of ordinary threads.
    bool lock_memory{true};               ///< All memory of the process, present and future.
    bool allow_no_rt{false};              ///< Run with what is granted and list what was refused.
    bool is_supervisor{false};            ///< One above kPriorityMax is in range, too.
    /// As long as the thread is not joined no processor of the machine sleeps deeply, where this
    /// can be had (on Linux /dev/cpu_dma_latency; root by default). Waking from a deep sleep may
    /// take longer than the loop can wait. It costs power.
    bool processors_awake{true};
};

/// What the thread really got.
struct RtThreadReport
{
    bool fifo{false};                     ///< Runs with SCHED_FIFO at the priority asked for.
    bool memory_locked{false};            ///< False as well when it was not asked for.
    bool pinned{false};                   ///< False as well when no processor was asked for.
    bool processors_awake{false};         ///< False as well when it was not asked for.
    bool float_control_was_default{true}; ///< False: see reset_float_control(); it is mended now.
    std::vector<std::string> refused;     ///< One line each, with what to do about it.
};

/// A thread for the haptic loop or its supervisor: SCHED_FIFO, pinned, on a stack that is already
/// in memory, with all signals blocked (they belong to the main thread) and the default
/// floating-point control. Joined on destruction.
///
/// One ordinary thread starts, joins and destroys it.
///
/// Locking memory concerns the whole process and stays in force afterwards. Threads started from
/// inside the body inherit its policy and processor: start others elsewhere.
class RtThread
{
public:
    /// Starts the thread, waits until it is set up, then lets `body` run. Without the privilege it
    /// is refused and says exactly what is missing, one line for each thing; no body has run then.
    /// With `allow_no_rt` it runs all the same and report() has those lines. `body` must not throw.
    /// A value out of range or a processor that this process may not use is refused as usage
    /// (`Refusal::is_usage`) in both cases. Without memory or a thread it is refused as a failure.
    [[nodiscard]] static Result<RtThread, Refusal> start(const RtThreadOptions& options,
                                                         std::function<void()> body);

    RtThread(RtThread&&) noexcept;
    RtThread& operator=(RtThread&&) noexcept;
    ~RtThread();

    /// Waits until the body has returned. No effect the second time.
    void join() noexcept;

    /// Lives as long as this; any thread.
    [[nodiscard]] const RtThreadReport& report() const noexcept;

private:
    struct Running;
    explicit RtThread(std::unique_ptr<Running> running) noexcept;

    std::unique_ptr<Running> running_;
};

/// What RtThread::start() would be refused on this machine, in the same lines; empty when nothing.
/// It really tries, on a short-lived thread, and leaves policy and locked memory as they were
/// before (memory that was locked already becomes unlocked: call it before the first start).
[[nodiscard]] Result<std::vector<std::string>, Refusal>
probe_realtime(const RtThreadOptions& options);

} // namespace tactus
