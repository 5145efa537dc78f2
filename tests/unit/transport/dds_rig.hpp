// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/log.hpp"

#include <chrono>
#include <cstdlib>
#include <functional>
#include <limits>
#include <mutex>
#include <string>
#include <thread>
#include <unistd.h>

/// Functions of all tests over real DDS.
namespace tactus::test
{

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Limit far beyond any regular time; only a broken build waits this long.
inline constexpr std::chrono::seconds kPatience{60};

/// Log lines from any thread.
struct Lines
{
    Log log()
    {
        return [this](const std::string& line)
        {
            const std::lock_guard lock(mutex_);
            text_ += line + "\n";
        };
    }
    [[nodiscard]] std::string text()
    {
        const std::lock_guard lock(mutex_);
        return text_;
    }
    [[nodiscard]] bool has(const std::string& part)
    {
        return text().find(part) != std::string::npos;
    }

private:
    std::mutex mutex_;
    std::string text_;
};

/// Isolates DDS: domains of this process communicate over loopback sockets as between processes,
/// and with no others; each call separates from earlier ones. The domains 161 to 200 are for the
/// calling programs, one of which runs at a time (tests/CMakeLists.txt, tests_with_sockets). A
/// participant that is silent for `lease_s` seconds is gone: a processor may be unavailable for
/// one.
inline void isolate_domains(int lease_s = 20)
{
    static int calls = static_cast<int>(::getpid());
    const int wire = 161 + calls++ % 40;
    const std::string uri =
        "<CycloneDDS><Domain id=\"any\"><General><Interfaces><NetworkInterface name=\"lo\" "
        "multicast=\"false\"/></Interfaces><AllowMulticast>false</AllowMulticast></General>"
        "<Discovery><ExternalDomainId>" +
        std::to_string(wire) +
        "</ExternalDomainId><ParticipantIndex>auto</ParticipantIndex><LeaseDuration>" +
        std::to_string(lease_s) +
        " s</LeaseDuration><Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery>"
        "<Internal><HeartbeatInterval min=\"2 ms\" minsched=\"2 ms\" max=\"20 ms\">5 ms"
        "</HeartbeatInterval><NackDelay>1 ms</NackDelay></Internal></Domain></CycloneDDS>";
    ::setenv("CYCLONEDDS_URI", uri.c_str(), 1);
}

/// Polls until the condition holds; false if it never does. No other function here waits for an
/// event, and no test has a time limit.
inline bool eventually(const std::function<bool()>& is_so)
{
    const auto start = std::chrono::steady_clock::now();
    while (!is_so())
    {
        if (std::chrono::steady_clock::now() - start > kPatience)
        {
            return false;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
}

} // namespace tactus::test
