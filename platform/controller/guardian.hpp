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

/// A process of its own that brakes devices when this one dies, by SIGKILL for instance: then
/// nothing here can. It holds the devices' guards and nothing else, its memory is locked, and it
/// runs with SCHED_FIFO where that is granted. It sleeps on a pipe whose other end is this process
/// alone: the end of the process closes it, at once and without a word. A crash writes to it
/// before the system writes a core, which takes its time while the motors hold the last force.
class Guardian
{
public:
    using Guards = std::vector<std::unique_ptr<DeviceGuard>>;
    using MakeGuards = std::function<Result<Guards, Refusal>()>;

    /// Forks, so there is no other thread yet. `make` runs in the new process; waits until it has
    /// its guards. Refused, in one line, when it can't be had or when `make` refuses; without
    /// memory or priority only where `allow_no_rt`. None, and no process, when no guard was made.
    [[nodiscard]] static Result<std::unique_ptr<Guardian>, Refusal>
    start(const MakeGuards& make, int priority, bool allow_no_rt);

    Guardian(const Guardian&) = delete;
    Guardian& operator=(const Guardian&) = delete;
    /// The devices are closed: it ends, and brakes nothing.
    ~Guardian();

    [[nodiscard]] pid_t process() const noexcept { return process_; }
    /// Whether it has ended by itself, or was killed.
    [[nodiscard]] bool has_died() noexcept;

private:
    Guardian(pid_t process, int life) : process_(process), life_(life) {}

    pid_t process_;
    int life_; ///< This end of the pipe.
    bool has_died_{false};
};

} // namespace tactus::hrtc
