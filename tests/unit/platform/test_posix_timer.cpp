// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/posix/posix_clock.hpp"
#include "platform/machine/posix/posix_periodic_timer.hpp"
#include "platform/machine/thread_usage.hpp"

#include <gtest/gtest.h>

#include <csignal>

namespace tactus
{
namespace
{

constexpr Duration kPosixPeriod = milliseconds(4);
constexpr Duration kMargin = microseconds(400);

// A handler has no access to the program's data.
volatile std::sig_atomic_t signals_seen = 0; // NOLINT(*-avoid-non-const-global-variables)

void count_signal(int /*number*/)
{
    signals_seen = signals_seen + 1;
}

/// Timer that interrupts this process, whose only thread is the test's, by SIGALRM each
/// millisecond: a quarter of the period.
struct Interruptions
{
    Interruptions()
    {
        struct sigaction action
        {
        };
        action.sa_handler = count_signal; // SA_RESTART is not set.
        EXPECT_EQ(sigaction(SIGALRM, &action, &before_), 0);
        sigevent event{};
        event.sigev_notify = SIGEV_SIGNAL;
        event.sigev_signo = SIGALRM;
        EXPECT_EQ(timer_create(CLOCK_MONOTONIC, &event, &timer_), 0);
        const itimerspec each{{0, 1'000'000}, {0, 1'000'000}};
        EXPECT_EQ(timer_settime(timer_, 0, &each, nullptr), 0);
    }
    Interruptions(const Interruptions&) = delete;
    Interruptions& operator=(const Interruptions&) = delete;
    ~Interruptions()
    {
        EXPECT_EQ(timer_delete(timer_), 0);
        EXPECT_EQ(sigaction(SIGALRM, &before_, nullptr), 0);
    }

private:
    timer_t timer_{};
    struct sigaction before_
    {
    };
};

TEST(PosixPeriodicTimer, is_not_woken_early_by_a_signal)
{
    const PosixClock clock;
    PosixPeriodicTimer sut;
    ASSERT_TRUE(sut.start(kPosixPeriod, kMargin));
    const Interruptions interruptions;
    signals_seen = 0;
    int interrupted = 0;
    while (interrupted < 5)
    {
        const auto before = signals_seen;
        sut.sleep_until_margin();
        const MonotonicTime woken = clock.now();
        interrupted += signals_seen > before ? 1 : 0;
        const Cycle cycle = sut.spin_until_deadline();
        if (cycle.periods == 1)
        {
            EXPECT_GE(woken, cycle.deadline - kMargin);
        }
    }
}

TEST(PosixPeriodicTimer, gives_the_processor_up_but_for_the_margin)
{
    const PosixClock clock;
    PosixPeriodicTimer sut;
    const MonotonicTime began = clock.now();
    const ThreadUsage before = read_thread_usage();
    ASSERT_TRUE(sut.start(kPosixPeriod, kMargin));
    for (int i = 0; i < 20; ++i)
    {
        sut.sleep_until_margin();
        static_cast<void>(sut.spin_until_deadline());
    }
    const ThreadUsage used = read_thread_usage() - before;
    EXPECT_LT(used.cpu_time * 2, clock.now() - began); // A tenth on an idle machine.
}

} // namespace
} // namespace tactus
