// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/device_guard.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <functional>
#include <memory>
#include <sys/types.h>
#include <vector>

namespace tactus::hrtc
{

/// Process that brakes the devices when hrtc's process dies, for instance by SIGKILL, when no code
/// of hrtc can run. The guardian holds only the devices' guards, in locked memory, and runs with
/// SCHED_FIFO where that is granted. It sleeps on a pipe whose writing end only hrtc has; the death
/// of hrtc closes the pipe without a message. A crash is reported through the pipe before the
/// system writes a core file, since the motors would hold the last force meanwhile.
class Guardian
{
public:
    using Guards = std::vector<std::unique_ptr<DeviceGuard>>;
    using MakeGuards = std::function<Result<Guards, Refusal>()>;

    /// Forks, so no other thread may run yet. `make` runs in the guardian's process, and start()
    /// waits until it has returned. Refused, in one line, if the process can't start or `make`
    /// refuses. Without locked memory or real-time priority the guardian starts only if
    /// `allow_no_rt` is set. Null, without a process, if `make` returns no guard.
    [[nodiscard]] static Result<std::unique_ptr<Guardian>, Refusal>
    start(const MakeGuards& make, int priority, bool allow_no_rt);

    Guardian(const Guardian&) = delete;
    Guardian& operator=(const Guardian&) = delete;
    /// Ends the guardian without a brake. The devices must be closed.
    ~Guardian();

    [[nodiscard]] pid_t process() const noexcept { return process_; }
    /// True if the guardian's process has ended.
    [[nodiscard]] bool has_died() noexcept;

private:
    Guardian(pid_t process, int life) : process_(process), life_(life) {}

    pid_t process_;
    int life_; ///< Writing end of the pipe, a file descriptor.
    bool has_died_{false};
};

} // namespace tactus::hrtc
