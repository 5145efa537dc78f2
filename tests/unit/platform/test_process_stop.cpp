// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/thread_usage.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace tactus
{

namespace
{

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
