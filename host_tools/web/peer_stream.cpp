// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/web/peer_stream.hpp"

#include "rt_core/base/assert.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <poll.h>
#include <sys/socket.h>

namespace tactus::web
{

namespace
{

/// Longest wait for a peer while other connections need a thread, divided by 1 + their number; at
/// least 1 ms.
constexpr std::chrono::milliseconds kGrace{40};

bool is_transient(int error)
{
    return error == EINTR || error == EAGAIN || error == EWOULDBLOCK;
}

} // namespace

void Connections::arrive()
{
    const std::lock_guard lock(mutex_);
    ++queued_;
    if (served_.size() + queued_ > threads_)
    {
        end_longest_wait();
    }
}

void Connections::begin(int socket)
{
    const std::lock_guard lock(mutex_);
    TACTUS_ASSERT(queued_ > 0);
    --queued_;
    served_.push_back({socket, std::nullopt});
}

void Connections::end(int socket)
{
    const std::lock_guard lock(mutex_);
    std::erase_if(served_, [socket](const Served& one) { return one.socket == socket; });
}

void Connections::end_all()
{
    const std::lock_guard lock(mutex_);
    is_ended_ = true;
    for (const Served& one : served_)
    {
        ::shutdown(one.socket, SHUT_RDWR);
    }
}

/// Closes the connection that has waited longest for its peer.
void Connections::end_longest_wait()
{
    Served* longest = nullptr;
    for (Served& one : served_)
    {
        const bool is_longer = longest == nullptr || one.waits_since < longest->waits_since;
        longest = one.waits_since && is_longer ? &one : longest;
    }
    if (longest != nullptr)
    {
        longest->waits_since.reset();
        ::shutdown(longest->socket, SHUT_RDWR);
    }
}

Connections::Served& Connections::served(int socket)
{
    const auto found = std::ranges::find(served_, socket, &Served::socket);
    TACTUS_ASSERT(found != served_.end());
    return *found;
}

bool Connections::wait(int socket, short events, Clock::time_point deadline)
{
    pollfd peer{socket, events, 0};
    if (::poll(&peer, 1, 0) > 0) // No wait, so no other connection is delayed.
    {
        return true;
    }
    {
        const std::lock_guard lock(mutex_);
        const auto now = Clock::now();
        if (queued_ > 0)
        {
            const auto grace = kGrace / static_cast<std::int64_t>(1 + queued_);
            deadline = std::min(deadline, now + std::max(grace, std::chrono::milliseconds(1)));
        }
        if (is_ended_)
        {
            return false;
        }
        served(socket).waits_since = now;
    }
    int ready = -1;
    do
    {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
        ready = ::poll(&peer, 1, static_cast<int>(std::max<std::int64_t>(left.count(), 0)));
    } while (ready < 0 && errno == EINTR);
    const std::lock_guard lock(mutex_);
    served(socket).waits_since.reset();
    return ready > 0;
}

bool PeerStream::is_readable() const
{
    return begin_ < end_ || connections_.wait(socket_, POLLIN, request_end_);
}

bool PeerStream::is_writable() const
{
    return connections_.wait(socket_, POLLOUT,
                             answer_end_.value_or(Clock::now() + kAnswerPatience));
}

/// Receives bytes into the buffer, which must be empty. False if there are none in time.
bool PeerStream::fill()
{
    while (received_ < kRequestMax && connections_.wait(socket_, POLLIN, request_end_))
    {
        const ssize_t count = ::recv(socket_, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
        if (count > 0)
        {
            begin_ = 0;
            end_ = static_cast<std::size_t>(count);
            received_ += end_;
            return true;
        }
        if (count == 0 || !is_transient(errno))
        {
            return false;
        }
    }
    return false;
}

ssize_t PeerStream::read(char* bytes, std::size_t size)
{
    if (begin_ == end_ && !fill())
    {
        return -1;
    }
    const std::size_t count = std::min(size, end_ - begin_);
    std::memcpy(bytes, buffer_.data() + begin_, count);
    begin_ += count;
    return static_cast<ssize_t>(count);
}

ssize_t PeerStream::write(const char* bytes, std::size_t size)
{
    if (!answer_end_)
    {
        answer_end_ = Clock::now() + kAnswerPatience;
    }
    while (connections_.wait(socket_, POLLOUT, *answer_end_))
    {
        const ssize_t count = ::send(socket_, bytes, size, MSG_DONTWAIT | MSG_NOSIGNAL);
        if (count >= 0)
        {
            if (static_cast<std::size_t>(count) == size)
            {
                answer_end_.reset();
            }
            return count;
        }
        if (!is_transient(errno))
        {
            return -1;
        }
    }
    return -1;
}

/// Gives the loopback address, and 0 for the port, which cpp-httplib never uses.
void PeerStream::get_remote_ip_and_port(std::string& ip, int& port) const
{
    ip = "127.0.0.1";
    port = 0;
}

void PeerStream::get_local_ip_and_port(std::string& ip, int& port) const
{
    get_remote_ip_and_port(ip, port);
}

} // namespace tactus::web
