// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/posix/service_notify.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <string_view>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace tactus
{

namespace
{

std::string_view variable(const char* name)
{
    const char* value = std::getenv(name);
    return value == nullptr ? std::string_view() : std::string_view(value);
}

std::optional<std::int64_t> number_in(std::string_view text)
{
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc{} && end == text.data() + text.size() ? std::optional(number)
                                                                    : std::nullopt;
}

/// Socket address of a path, or of an abstract name after '@'; empty for other forms.
std::string address_in(std::string_view text)
{
    const bool is_known = text.size() > 1 && text.size() < sizeof(sockaddr_un{}.sun_path) &&
                          (text.front() == '/' || text.front() == '@');
    std::string address(is_known ? text : std::string_view());
    std::ranges::replace(address.begin(), address.begin() + (is_known ? 1 : 0), '@', '\0');
    return address;
}

} // namespace

ServiceNotify::ServiceNotify() : address_(address_in(variable("NOTIFY_SOCKET")))
{
    if (address_.empty())
    {
        return;
    }
    socket_ = socket(AF_UNIX, SOCK_DGRAM, 0);
    if (socket_ >= 0)
    {
        fcntl(socket_, F_SETFD, FD_CLOEXEC);
        fcntl(socket_, F_SETFL, O_NONBLOCK); // A manager that doesn't read blocks no thread.
    }
    const auto pid = number_in(variable("WATCHDOG_PID"));
    const auto time_us = number_in(variable("WATCHDOG_USEC"));
    if ((!pid || *pid == getpid()) && time_us && *time_us > 0 && *time_us <= 86'400'000'000)
    {
        watchdog_ = microseconds(*time_us);
    }
}

ServiceNotify::~ServiceNotify()
{
    if (socket_ >= 0)
    {
        close(socket_);
    }
}

void ServiceNotify::alive(MonotonicTime now) noexcept
{
    if (watchdog_ && (!sent_ || (now - *sent_) * 4 >= *watchdog_))
    {
        sent_ = now;
        send("WATCHDOG=1");
    }
}

void ServiceNotify::send(const char* state) noexcept
{
    if (socket_ < 0)
    {
        return;
    }
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, address_.data(), address_.size());
    const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + address_.size());
    static_cast<void>(sendto(socket_, state, std::strlen(state), MSG_NOSIGNAL,
                             reinterpret_cast<const sockaddr*>(&address), length));
}

} // namespace tactus
