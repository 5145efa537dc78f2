// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/program/run_program.hpp"

#include <gtest/gtest.h>

#include <array>
#include <csignal>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace tactus
{
namespace
{

/// Exit code of a separate process, or the negative number of the signal that ended it.
template <typename Work>
int code_of(const Work& work)
{
    const pid_t process = ::fork();
    if (process == 0)
    {
        ::_exit(work());
    }
    int status = 0;
    EXPECT_EQ(::waitpid(process, &status, 0), process);
    return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

/// Exit code; 1 if the signal requested the end.
int code_after(int signal)
{
    return code_of(
        [signal]
        {
            stop_on_signals();
            ::raise(signal);
            return is_stop_requested() ? 1 : 0;
        });
}

TEST(StopSignals, ask_the_program_to_end)
{
    for (const int signal : {SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXCPU, SIGALRM, SIGUSR1, SIGUSR2})
    {
        EXPECT_EQ(code_after(signal), 1) << signal;
    }
    EXPECT_EQ(code_after(SIGKILL), -SIGKILL);
}

TEST(StopSignals, of_a_reader_that_is_gone_and_of_a_file_that_is_full_do_nothing)
{
    EXPECT_EQ(code_after(SIGPIPE), 0);
    EXPECT_EQ(code_after(SIGXFSZ), 0);
}

TEST(StopSignals, that_nohup_ignores_stay_ignored)
{
    const auto hang_up = []
    {
        std::signal(SIGHUP, SIG_IGN);
        stop_on_signals();
        ::raise(SIGHUP);
        return is_stop_requested() ? 1 : 0;
    };
    EXPECT_EQ(code_of(hang_up), 0);
}

TEST(PrintOut, goes_on_where_nobody_reads)
{
    const auto print = []
    {
        stop_on_signals();
        std::array<int, 2> pipe{};
        if (::pipe(pipe.data()) != 0 || ::dup2(pipe[1], STDOUT_FILENO) < 0)
        {
            return 2;
        }
        ::close(pipe[0]);
        ::close(pipe[1]);
        print_out(std::string(100'000, 'a'));
        ::close(STDOUT_FILENO);
        print_out("a");
        return 0;
    };
    EXPECT_EQ(code_of(print), 0);
}

} // namespace
} // namespace tactus
