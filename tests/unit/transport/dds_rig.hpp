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

/// What tests over real DDS share.
namespace tactus::test
{

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Far beyond what anything here takes; only a broken build waits this long.
inline constexpr std::chrono::seconds kPatience{60};

/// Lines from any thread.
class Lines
{
public:
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

/// Domains of this process meet each other on the network, over loopback sockets as between
/// processes, and nobody else's; those of each call another time no earlier call's. The domains 161
/// to 200 are for the programs that call this, one of which runs at a time
/// (tests/CMakeLists.txt, tests_with_sockets). Who says
/// nothing for `lease_s` seconds is gone: a processor may well be away for one.
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

/// Asks until it is so; false when it never is. Nothing else here waits for an event, and no test
/// expects one within a time.
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
