// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/own_network.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <net/if.h>
#include <sched.h>
#include <string>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tactus::bench
{

void enter_own_network()
{
    const auto refuse = [](const char* what)
    { throw Failure(fmt::format("no network of its own: {}: {}", what, std::strerror(errno))); };
    if (::unshare(CLONE_NEWNET) != 0)
    {
        refuse("unshare");
    }
    const int any = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    ifreq loopback{};
    std::strcpy(loopback.ifr_name, "lo");
    const bool is_read = any >= 0 && ::ioctl(any, SIOCGIFFLAGS, &loopback) == 0;
    loopback.ifr_flags = static_cast<short>(loopback.ifr_flags | IFF_UP);
    const bool is_up = is_read && ::ioctl(any, SIOCSIFFLAGS, &loopback) == 0;
    ::close(any);
    if (!is_up)
    {
        refuse("loopback");
    }
}

std::uint64_t loopback_bytes()
{
    std::ifstream file("/proc/self/net/dev");
    std::uint64_t bytes = 0;
    for (std::string word; file >> word;)
    {
        if (word == "lo:")
        {
            file >> bytes;
            break;
        }
    }
    return bytes;
}

} // namespace tactus::bench
