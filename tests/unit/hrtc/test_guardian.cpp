// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/controller/guardian.hpp"

#include <gtest/gtest.h>

#include <array>
#include <csignal>
#include <memory>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

namespace tactus::hrtc
{
namespace
{

/// Guard that writes its letter to a pipe.
struct Told final : DeviceGuard
{
    Told(int pipe, char letter) : pipe_(pipe), letter_(letter) {}

    [[nodiscard]] bool brake() noexcept override { return ::write(pipe_, &letter_, 1) == 1; }

private:
    int pipe_;
    char letter_;
};

struct GuardianTest : testing::Test
{
    void SetUp() override { ASSERT_EQ(::pipe(pipe_.data()), 0); }
    void TearDown() override { ::close(pipe_[0]); }

    [[nodiscard]] Result<std::unique_ptr<Guardian>, Refusal> start() const
    {
        const auto make = [this]() -> Result<Guardian::Guards, Refusal>
        {
            Guardian::Guards guards;
            guards.push_back(std::make_unique<Told>(pipe_[1], 'a'));
            guards.push_back(std::make_unique<Told>(pipe_[1], 'b'));
            return guards;
        };
        return Guardian::start(make, 80, true);
    }
    /// Letters of the guards after a process with a guardian ends by `end`.
    template <typename End>
    std::string told_after(const End& end)
    {
        const pid_t process = ::fork();
        if (process == 0)
        {
            auto guardian = start();
            ::close(pipe_[1]);
            end(std::move(guardian).value());
            ::_exit(0);
        }
        EXPECT_EQ(::waitpid(process, nullptr, 0), process);
        return read_all();
    }
    /// Reads until all processes have closed the pipe.
    std::string read_all()
    {
        ::close(pipe_[1]);
        std::string all;
        char letter = 0;
        while (::read(pipe_[0], &letter, 1) == 1)
        {
            all += letter;
        }
        return all;
    }

    std::array<int, 2> pipe_{};
};

TEST_F(GuardianTest, brakes_all_devices_of_a_process_that_is_killed)
{
    EXPECT_EQ(told_after([](const auto&) { ::raise(SIGKILL); }), "ab");
}

TEST_F(GuardianTest, brakes_the_devices_of_a_process_that_leaves_without_a_word)
{
    EXPECT_EQ(told_after([](const auto&) { ::_exit(2); }), "ab");
}

TEST_F(GuardianTest, brakes_when_a_process_crashes_and_again_when_it_has_ended)
{
    EXPECT_EQ(told_after([](const auto&) { ::raise(SIGABRT); }), "abab");
}

TEST_F(GuardianTest, lets_a_crash_end_the_process_as_it_would_have)
{
    const pid_t process = ::fork();
    if (process == 0)
    {
        ::signal(SIGSEGV, SIG_DFL); // A sanitizer's handler would end the process otherwise.
        const auto guardian = start();
        ::kill(::getpid(), SIGSEGV); // The signal is from outside, so that it is not repeated.
        ::_exit(0);
    }
    int status = 0;
    EXPECT_EQ(::waitpid(process, &status, 0), process);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGSEGV);
    EXPECT_EQ(read_all(), "abab");
}

TEST_F(GuardianTest, brakes_nothing_when_the_devices_are_closed)
{
    EXPECT_EQ(told_after([](auto guardian) { guardian.reset(); }), "");
}

TEST_F(GuardianTest, outlives_the_signals_that_end_all_processes_of_a_terminal_or_a_service)
{
    const auto end = [](const std::unique_ptr<Guardian>& guardian)
    {
        for (const int signal : {SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGPIPE, SIGUSR1})
        {
            EXPECT_EQ(::kill(guardian->process(), signal), 0);
        }
        ::raise(SIGKILL);
    };
    EXPECT_EQ(told_after(end), "ab");
}

TEST_F(GuardianTest, is_missed_when_it_is_gone)
{
    auto guardian = start();
    ASSERT_TRUE(guardian);
    EXPECT_FALSE(guardian.value()->has_died());
    ::kill(guardian.value()->process(), SIGKILL);
    while (!guardian.value()->has_died())
    {
        ::usleep(1'000);
    }
    EXPECT_TRUE(guardian.value()->has_died());
    guardian.value().reset();
    EXPECT_EQ(read_all(), "");
}

TEST_F(GuardianTest, is_refused_when_a_guard_refuses_and_none_where_there_is_no_guard)
{
    const auto refused =
        Guardian::start([]() -> Result<Guardian::Guards, Refusal>
                        { return Refusal{"left.so: has no second line to its motors"}; },
                        80, true);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().text,
              "the guardian can't start: left.so: has no second line to its motors");
    const auto died =
        Guardian::start([]() -> Result<Guardian::Guards, Refusal> { ::_exit(1); }, 80, true);
    ASSERT_FALSE(died);
    EXPECT_EQ(died.error().text, "the guardian can't start: its process ended before it was ready");
    const auto none = Guardian::start(
        []() -> Result<Guardian::Guards, Refusal> { return Guardian::Guards{}; }, 80, true);
    ASSERT_TRUE(none);
    EXPECT_EQ(none.value(), nullptr);
}

} // namespace
} // namespace tactus::hrtc
