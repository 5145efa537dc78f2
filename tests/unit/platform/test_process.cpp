// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/posix/service_notify.hpp"
#include "platform/machine/thread_usage.hpp"
#include "tests/shared/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace tactus
{
namespace
{

/// Service manager that listens at a path, or in the abstract namespace if `name` begins with '@'.
struct Manager
{
    explicit Manager(const std::string& name) : socket_(socket(AF_UNIX, SOCK_DGRAM, 0))
    {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::memcpy(address.sun_path, name.data(), name.size());
        if (name.front() == '@')
        {
            address.sun_path[0] = '\0';
        }
        const std::size_t length = offsetof(sockaddr_un, sun_path) + name.size();
        EXPECT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&address),
                       static_cast<socklen_t>(length)),
                  0);
        setenv("NOTIFY_SOCKET", name.c_str(), 1);
    }
    Manager(const Manager&) = delete;
    Manager& operator=(const Manager&) = delete;
    ~Manager()
    {
        close(socket_);
        for (const char* variable : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"})
        {
            unsetenv(variable);
        }
    }

    /// All messages so far.
    [[nodiscard]] std::vector<std::string> heard() const
    {
        std::vector<std::string> all;
        std::array<char, 256> text{};
        for (;;)
        {
            const ssize_t size = recv(socket_, text.data(), text.size(), MSG_DONTWAIT);
            if (size < 0)
            {
                return all;
            }
            all.emplace_back(text.data(), static_cast<std::size_t>(size));
        }
    }

private:
    int socket_;
};

using Words = std::vector<std::string>;

TEST(ServiceNotify, tells_a_manager_at_a_path_or_in_no_folder)
{
    const test::TemporaryFolder folder("notify");
    for (const std::string& name :
         {(folder.path() / "notify").string(), "@tactus-test-" + std::to_string(getpid())})
    {
        const Manager manager(name);
        ServiceNotify sut;
        sut.ready();
        sut.stopping();
        EXPECT_EQ(manager.heard(), (Words{"READY=1", "STOPPING=1"})) << name;
    }
}

TEST(ServiceNotify, keeps_a_watchdog_quiet_with_a_few_words)
{
    const Manager manager("@tactus-test-" + std::to_string(getpid()));
    setenv("WATCHDOG_USEC", "2000000", 1);
    setenv("WATCHDOG_PID", std::to_string(getpid()).c_str(), 1);
    ServiceNotify sut;
    ASSERT_EQ(sut.watchdog(), milliseconds(2'000));
    for (std::int64_t ms = 0; ms <= 2'000; ++ms)
    {
        sut.alive(MonotonicTime{ms * 1'000'000});
    }
    EXPECT_EQ(manager.heard(), Words(5, "WATCHDOG=1")); // Times 0, 500, ... 2,000 ms.
}

TEST(ServiceNotify, has_no_watchdog_when_it_is_another_processes_or_makes_no_sense)
{
    const Manager manager("@tactus-test-" + std::to_string(getpid()));
    const auto heard_with = [&manager](const char* time_us, const std::string& pid)
    {
        setenv("WATCHDOG_USEC", time_us, 1);
        setenv("WATCHDOG_PID", pid.c_str(), 1);
        ServiceNotify sut;
        sut.alive({});
        return manager.heard().size();
    };
    const std::string own = std::to_string(getpid());
    EXPECT_EQ(heard_with("1000", own), 1U);
    EXPECT_EQ(heard_with("1000", "1"), 0U);
    for (const char* time : {"", "0", "-5", "soon", "1e6", "99999999999999999999"})
    {
        EXPECT_EQ(heard_with(time, own), 0U) << time;
    }
}

TEST(ServiceNotify, does_nothing_without_a_manager_or_with_one_that_is_gone)
{
    for (const char* name : {"", "/nowhere/socket", "relative", "@", "vsock:2:1"})
    {
        setenv("NOTIFY_SOCKET", name, 1);
        ServiceNotify sut;
        sut.ready();
        sut.alive({});
        sut.stopping();
    }
    setenv("NOTIFY_SOCKET", ("/" + std::string(200, 'x')).c_str(), 1);
    ServiceNotify too_long;
    too_long.ready();
    unsetenv("NOTIFY_SOCKET");
    EXPECT_FALSE(ServiceNotify().watchdog());
}

/// Result: 1 for the first answer, 2 for the second.
int look_twice()
{
    const int first = take_process_stop() ? 1 : 0;
    return first + (take_process_stop() ? 2 : 0);
}

/// Stops that a child detected, as its exit code.
int after_stops(int stops)
{
    const pid_t child = fork();
    if (child == 0)
    {
        watch_process_stops();
        for (int i = 0; i < stops; ++i)
        {
            static_cast<void>(raise(SIGSTOP));
        }
        _exit(look_twice());
    }
    int status = 0;
    while (waitpid(child, &status, WUNTRACED) == child && WIFSTOPPED(status))
    {
        kill(child, SIGCONT);
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(ProcessStop, is_seen_once_however_often_the_process_was_stopped)
{
    EXPECT_EQ(after_stops(0), 0);
    EXPECT_EQ(after_stops(1), 1);
    EXPECT_EQ(after_stops(3), 1);
}

TEST(ProcessStop, is_seen_by_a_thread_that_was_started_later)
{
    sigset_t before;
    ASSERT_EQ(pthread_sigmask(SIG_BLOCK, nullptr, &before), 0);
    watch_process_stops();
    int seen = -1;
    std::thread later(
        [&seen]
        {
            kill(getpid(), SIGCONT); // SIGCONT works without a stop.
            seen = look_twice();
        });
    later.join();
    EXPECT_EQ(seen, 1);
    EXPECT_EQ(pthread_sigmask(SIG_SETMASK, &before, nullptr), 0);
}

} // namespace
} // namespace tactus
