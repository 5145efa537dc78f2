// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/time.hpp"

#include <optional>
#include <string>

namespace tactus
{

/// Reports a program's state to a service manager by the protocol of sd_notify(3): datagrams to the
/// socket of an environment variable. No effect without a manager. Not for the haptic thread.
class ServiceNotify
{
public:
    /// Reads NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID.
    ServiceNotify();
    ServiceNotify(const ServiceNotify&) = delete;
    ServiceNotify& operator=(const ServiceNotify&) = delete;
    ~ServiceNotify();

    void ready() noexcept { send("READY=1"); }
    void stopping() noexcept { send("STOPPING=1"); }

    /// Resets the manager's watchdog; call it as work progresses. Sends at most four times in the
    /// watchdog's time.
    void alive(MonotonicTime now) noexcept;

    /// Time of the watchdog; none without one.
    [[nodiscard]] const std::optional<Duration>& watchdog() const noexcept { return watchdog_; }

private:
    void send(const char* state) noexcept;

    int socket_{-1};
    /// Address as in sockaddr_un::sun_path, an abstract one with its leading zero.
    std::string address_;
    std::optional<Duration> watchdog_;
    std::optional<MonotonicTime> sent_;
};

} // namespace tactus
