// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/loopback_sockets.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <netinet/in.h>
#include <string_view>
#include <sys/socket.h>
#include <system_error>
#include <vector>

namespace tactus::dds
{

namespace
{

#ifdef SO_BINDTODEVICE

/// True if the socket receives datagrams from every interface.
bool receives_from_everywhere(int descriptor)
{
    int kind = 0;
    socklen_t size = sizeof(kind);
    sockaddr_in address{};
    socklen_t address_size = sizeof(address);
    return ::getsockopt(descriptor, SOL_SOCKET, SO_TYPE, &kind, &size) == 0 && kind == SOCK_DGRAM &&
           ::getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &address_size) == 0 &&
           address.sin_family == AF_INET && address.sin_port != 0 &&
           address.sin_addr.s_addr == htonl(INADDR_ANY);
}

/// Descriptors of this process's sockets that receive from every interface, ascending.
std::vector<int> open_to_everywhere()
{
    std::vector<int> found;
    std::error_code ignored; // A descriptor closed meanwhile is skipped.
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", ignored))
    {
        const std::string name = entry.path().filename().string();
        int descriptor = -1;
        std::from_chars(name.data(), name.data() + name.size(), descriptor);
        if (receives_from_everywhere(descriptor))
        {
            found.push_back(descriptor);
        }
    }
    std::ranges::sort(found);
    return found;
}

#endif

} // namespace

std::optional<std::string> opened_on_loopback(const std::function<void()>& open_sockets)
{
#ifdef SO_BINDTODEVICE
    constexpr std::string_view kLoopback = "lo";
    const std::vector<int> before = open_to_everywhere();
    open_sockets();
    for (const int descriptor : open_to_everywhere())
    {
        if (!std::ranges::binary_search(before, descriptor) &&
            ::setsockopt(descriptor, SOL_SOCKET, SO_BINDTODEVICE, kLoopback.data(),
                         static_cast<socklen_t>(kLoopback.size())) != 0)
        {
            return std::strerror(errno);
        }
    }
#else
    open_sockets();
#endif
    return std::nullopt;
}

} // namespace tactus::dds
