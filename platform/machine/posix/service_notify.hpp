// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/time.hpp"

#include <optional>
#include <string>

namespace tactus
{

/// Tells a service manager how a program is doing, by the protocol of sd_notify(3): datagrams to
/// the socket that the environment names. Without a manager all of it does nothing. Not for the
/// haptic thread.
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

    /// Keeps the manager's watchdog quiet; call it whenever the work has got on. Sends at most four
    /// times in the watchdog's time.
    void alive(MonotonicTime now) noexcept;

    /// None without a watchdog.
    [[nodiscard]] const std::optional<Duration>& watchdog() const noexcept { return watchdog_; }

private:
    void send(const char* state) noexcept;

    int socket_{-1};
    std::string address_; ///< As in sockaddr_un::sun_path, an abstract one with its leading zero.
    std::optional<Duration> watchdog_;
    std::optional<MonotonicTime> sent_;
};

} // namespace tactus
