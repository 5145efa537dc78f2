// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/float_control.hpp"
#include "platform/machine/posix/memory_lock.hpp"
#include "platform/machine/rt_thread.hpp"
#include "platform/machine/thread_usage.hpp"
#include "tests/shared/sanitizers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tactus
{
namespace
{

/// Properties of a thread, found by its body.
struct Seen
{
    bool ran{false};
    int policy{-1};
    int priority{-1};
    int cpu{-1};
    bool term_blocked{false};
};

void look_around(Seen& seen)
{
    sched_param parameter{};
    seen.ran = true;
    EXPECT_EQ(pthread_getschedparam(pthread_self(), &seen.policy, &parameter), 0);
    seen.priority = parameter.sched_priority;
    seen.cpu = sched_getcpu();
    sigset_t blocked;
    EXPECT_EQ(pthread_sigmask(SIG_BLOCK, nullptr, &blocked), 0);
    seen.term_blocked = sigismember(&blocked, SIGTERM) == 1;
}

RtThreadOptions without_lock()
{
    RtThreadOptions options;
    options.lock_memory = false;
    return options;
}

RtThreadOptions as_far_as_allowed()
{
    RtThreadOptions options = without_lock();
    options.allow_no_rt = true;
    return options;
}

/// Findings of a thread's body, with the report after its end.
struct Ran
{
    Seen seen{};
    RtThreadReport report{};
};

Ran run(const RtThreadOptions& options)
{
    Ran ran;
    auto started = RtThread::start(options, [&ran] { look_around(ran.seen); });
    EXPECT_TRUE(started) << (started ? "" : started.error().text);
    if (started)
    {
        started.value().join();
        ran.report = started.value().report();
    }
    return ran;
}

std::string why_no_fifo()
{
    const auto refused = probe_realtime(without_lock());
    return refused.value().empty() ? std::string() : refused.value().front();
}

/// Runs `check` as an ordinary user with the given limits; returns its exit status, 77 if this user
/// cannot become another. The child creates no thread.
template <typename Check>
int exit_status_without_privilege(rlim_t rtprio, rlim_t memlock, const Check& check)
{
    const pid_t child = fork();
    if (child == 0)
    {
        const rlimit priority_limit{rtprio, rtprio};
        const rlimit memory_limit{memlock, memlock};
        if (setrlimit(RLIMIT_RTPRIO, &priority_limit) != 0 ||
            setrlimit(RLIMIT_MEMLOCK, &memory_limit) != 0 || setgid(65'534) != 0 ||
            setuid(65'534) != 0)
        {
            _exit(77);
        }
        _exit(check());
    }
    int status = 0;
    EXPECT_EQ(waitpid(child, &status, 0), child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 255;
}

/// Skips if this user can't become another.
void expect_done(int status)
{
    if (status == 77)
    {
        GTEST_SKIP() << "needs to start as root to try the refusals of an ordinary user";
    }
    EXPECT_EQ(status, 0);
}

/// True if a sanitizer replaces mlockall, which then never refuses and locks nothing.
constexpr bool mlockall_is_replaced()
{
    return TACTUS_HAS_ADDRESS_SANITIZER != 0 || TACTUS_HAS_THREAD_SANITIZER != 0;
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

TEST(RtThread, runs_its_body_with_fifo_at_the_priority_asked_for)
{
    if (const std::string why = why_no_fifo(); !why.empty())
    {
        GTEST_SKIP() << why;
    }
    RtThreadOptions options = without_lock();
    options.priority = 42;
    const Ran ran = run(options);
    EXPECT_EQ(ran.seen.policy, SCHED_FIFO);
    EXPECT_EQ(ran.seen.priority, 42);
    EXPECT_TRUE(ran.report.fifo);
    EXPECT_TRUE(ran.report.refused.empty());
}

TEST(RtThread, does_not_pass_the_starters_policy_on_where_fifo_is_not_wanted_by_it)
{
    const Ran ran = run(as_far_as_allowed());
    EXPECT_EQ(ran.seen.policy, ran.report.fifo ? SCHED_FIFO : SCHED_OTHER);
    EXPECT_EQ(ran.report.refused.empty(), ran.report.fifo);
}

TEST(RtThread, pins_the_body_to_the_processor_asked_for)
{
    RtThreadOptions options = as_far_as_allowed();
    cpu_set_t allowed;
    ASSERT_EQ(sched_getaffinity(0, sizeof(allowed), &allowed), 0);
    int last = -1;
    for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu)
    {
        last = CPU_ISSET(static_cast<std::size_t>(cpu), &allowed) ? cpu : last;
    }
    options.cpu = last;
    const Ran ran = run(options);
    EXPECT_EQ(ran.seen.cpu, last);
    EXPECT_TRUE(ran.report.pinned);
}

TEST(RtThread, refuses_a_processor_that_does_not_exist_and_names_those_that_do)
{
    for (const int cpu : {-1, 1'000, 1'000'000})
    {
        RtThreadOptions options = as_far_as_allowed();
        options.cpu = cpu;
        bool ran = false;
        const auto refused = RtThread::start(options, [&] { ran = true; });
        ASSERT_FALSE(refused);
        EXPECT_TRUE(refused.error().is_usage);
        EXPECT_TRUE(contains(refused.error().text, "processor " + std::to_string(cpu)));
        EXPECT_TRUE(contains(refused.error().text, "may use 0"));
        EXPECT_FALSE(ran);
    }
}

TEST(RtThread, refuses_priorities_and_stacks_out_of_range)
{
    for (const int priority : {-1, 0, 99, 100})
    {
        RtThreadOptions options = without_lock();
        options.priority = priority;
        const auto refused = RtThread::start(options, [] {});
        ASSERT_FALSE(refused);
        EXPECT_TRUE(refused.error().is_usage);
        EXPECT_TRUE(contains(refused.error().text, "1..98"));
        EXPECT_FALSE(probe_realtime(options));
    }
    RtThreadOptions above = as_far_as_allowed();
    above.is_supervisor = true;
    above.priority = 99; // Priority of the supervisor of a loop at the highest.
    EXPECT_TRUE(RtThread::start(above, [] {}));
    above.priority = 100;
    EXPECT_FALSE(RtThread::start(above, [] {}));
    for (const std::size_t bytes : {std::size_t{0}, std::size_t{65'535}, std::size_t{67'108'865}})
    {
        RtThreadOptions options = without_lock();
        options.stack_bytes = bytes;
        const auto refused = RtThread::start(options, [] {});
        ASSERT_FALSE(refused);
        EXPECT_TRUE(contains(refused.error().text, "65536..67108864 bytes"));
    }
}

TEST(RtThread, blocks_signals_in_the_body_and_leaves_the_starters_alone)
{
    Seen here_before;
    look_around(here_before);
    EXPECT_TRUE(run(as_far_as_allowed()).seen.term_blocked);
    Seen here_after;
    look_around(here_after);
    EXPECT_EQ(here_after.term_blocked, here_before.term_blocked);
}

TEST(RtThread, has_its_stack_in_memory_before_the_body_runs)
{
    RtThreadOptions options = as_far_as_allowed();
    options.stack_bytes = 2048 * 1024;
    std::int64_t faults = -1;
    const auto touch_deep = [&]
    {
        const ThreadUsage before = read_thread_usage();
        std::array<volatile char, 768 * 1024> deep;
        for (std::size_t i = 0; i < deep.size(); i += 4'096)
        {
            deep[i] = 1;
        }
        faults = (read_thread_usage() - before).minor_faults;
    };
    auto started = RtThread::start(options, touch_deep);
    ASSERT_TRUE(started);
    started.value().join();
    // 192 if each page were loaded separately; code pages and sanitizers may add some.
    EXPECT_LT(faults, 96);
}

TEST(RtThread, joins_once_and_on_destruction)
{
    RtThreadOptions options = as_far_as_allowed();
    bool ran = false;
    {
        auto started = RtThread::start(options, [&] { ran = true; });
        ASSERT_TRUE(started);
        RtThread moved = std::move(started).value();
    }
    EXPECT_TRUE(ran);
    auto started = RtThread::start(options, [] {});
    ASSERT_TRUE(started);
    started.value().join();
    started.value().join();
}

TEST(RtThread, locks_the_memory_of_the_process)
{
    RtThreadOptions options;
    const auto probed = probe_realtime(options);
    ASSERT_TRUE(probed);
    if (!probed.value().empty())
    {
        GTEST_SKIP() << probed.value().front();
    }
    auto started = RtThread::start(options, [] {});
    ASSERT_TRUE(started) << started.error().text;
    EXPECT_TRUE(started.value().report().memory_locked);
    started.value().join();
    posix::unlock_all_memory();
}

/// Longest wake-up time in microseconds that the processes request.
std::int32_t longest_wake_us()
{
    std::int32_t time_us = -1;
    std::ifstream file("/dev/cpu_dma_latency", std::ios::binary);
    file.read(reinterpret_cast<char*>(&time_us), sizeof(time_us));
    return file ? time_us : -1;
}

/// Number of open descriptors of that file in this process.
std::ptrdiff_t requests_held()
{
    return std::ranges::count_if(std::filesystem::directory_iterator("/proc/self/fd"),
                                 [](const auto& entry)
                                 {
                                     std::error_code error;
                                     return std::filesystem::read_symlink(entry.path(), error) ==
                                            "/dev/cpu_dma_latency";
                                 });
}

TEST(RtThread, keeps_the_processors_awake_until_it_is_joined)
{
    RtThreadOptions options = as_far_as_allowed();
    const std::ptrdiff_t before = requests_held();
    std::int32_t asked_us = -1;
    auto started = RtThread::start(options, [&] { asked_us = longest_wake_us(); });
    ASSERT_TRUE(started);
    EXPECT_EQ(requests_held(), before + (started.value().report().processors_awake ? 1 : 0));
    started.value().join();
    EXPECT_EQ(requests_held(), before);
    if (!started.value().report().processors_awake)
    {
        GTEST_SKIP() << "/dev/cpu_dma_latency can't be written";
    }
    EXPECT_EQ(asked_us, 0);
}

TEST(RtThread, lets_the_processors_sleep_where_it_was_not_asked)
{
    RtThreadOptions options = as_far_as_allowed();
    options.processors_awake = false;
    const std::ptrdiff_t before = requests_held();
    std::ptrdiff_t meanwhile = -1;
    auto started = RtThread::start(options, [&] { meanwhile = requests_held(); });
    ASSERT_TRUE(started);
    started.value().join();
    EXPECT_EQ(meanwhile, before);
    EXPECT_FALSE(started.value().report().processors_awake);
}

TEST(RtThread, says_what_is_missing_for_fifo_to_an_ordinary_user)
{
    const int status = exit_status_without_privilege(
        0, 0,
        []
        {
            bool ran = false;
            const auto refused = RtThread::start(without_lock(), [&] { ran = true; });
            if (refused || ran || refused.error().is_usage)
            {
                return 1;
            }
            const std::string& line = refused.error().text;
            return contains(line, "SCHED_FIFO 80 refused (EPERM): RLIMIT_RTPRIO is 0; add '") &&
                           contains(line, " - rtprio 99' to /etc/security/limits.d/tactus.conf") &&
                           contains(line, "CAP_SYS_NICE") && !contains(line, "\n")
                       ? 0
                       : 2;
        });
    expect_done(status);
}

TEST(RtThread, says_what_is_missing_for_locked_memory)
{
    if (mlockall_is_replaced())
    {
        GTEST_SKIP() << "mlockall: replaced by the sanitizer";
    }
    for (const rlim_t limit : {rlim_t{0}, rlim_t{64 * 1024}})
    {
        const int status = exit_status_without_privilege(
            0, limit,
            [limit]
            {
                const auto line = posix::lock_all_memory();
                const std::string amount = "RLIMIT_MEMLOCK is " + std::to_string(limit) + " bytes";
                return line && contains(*line, "mlockall refused (") && contains(*line, amount) &&
                               contains(*line, " - memlock unlimited' to /etc/security") &&
                               contains(*line, "CAP_IPC_LOCK")
                           ? 0
                           : 1;
            });
        expect_done(status);
    }
}

TEST(RtThread, runs_without_privilege_when_allowed_and_lists_both_refusals)
{
    if (mlockall_is_replaced())
    {
        GTEST_SKIP() << "mlockall: replaced by the sanitizer";
    }
    const int status = exit_status_without_privilege(
        0, 0,
        []
        {
            RtThreadOptions options;
            options.allow_no_rt = true;
            Seen seen;
            auto started = RtThread::start(options, [&] { look_around(seen); });
            if (!started)
            {
                return 1;
            }
            started.value().join();
            const RtThreadReport& report = started.value().report();
            const auto probed = probe_realtime(RtThreadOptions{});
            return seen.ran && seen.policy == SCHED_OTHER && !report.fifo &&
                           !report.memory_locked && report.refused.size() == 2 && probed &&
                           probed.value() == report.refused
                       ? 0
                       : 2;
        });
    expect_done(status);
}

} // namespace
} // namespace tactus
