// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/load.hpp"
#include "platform/machine/thread_usage.hpp"

#include <gtest/gtest.h>

namespace tactus::hrtc::test
{

namespace
{

int turns_left = 0;

bool has_turns_left()
{
    return turns_left-- > 0;
}

TEST(Load, knows_its_kinds_by_name)
{
    for (std::size_t i = 0; i < kLoadNames.size(); ++i)
    {
        EXPECT_EQ(parse_load(kLoadNames[i]), static_cast<LoadKind>(i));
    }
    for (const char* other : {"", "none", "CPU", "cpu "})
    {
        EXPECT_FALSE(parse_load(other)) << other;
    }
}

TEST(Load, works_as_long_as_it_is_asked_to_and_no_longer)
{
    for (const LoadKind kind : {LoadKind::cpu, LoadKind::memory, LoadKind::disk})
    {
        turns_left = 2;
        const Duration before = read_thread_cpu_time();
        const auto fault = work(kind, has_turns_left);
        EXPECT_FALSE(fault) << *fault;
        EXPECT_EQ(turns_left, -1);
        EXPECT_GT(read_thread_cpu_time() - before, microseconds(100)); // The load was active.
    }
}

TEST(Load, tells_of_a_worker_that_has_ended)
{
    auto load = Load::start(std::vector{LoadKind::disk}, "/bin/true");
    ASSERT_TRUE(load);
    std::optional<LoadKind> ended;
    while (!ended)
    {
        ended = load.value().ended();
    }
    EXPECT_EQ(ended, LoadKind::disk);
    EXPECT_FALSE(load.value().ended()); // There was only one.
}

TEST(Load, tells_of_a_program_that_is_not_there)
{
    const auto load = Load::start(std::vector{LoadKind::cpu}, "/nowhere/hrtc");
    ASSERT_FALSE(load);
    EXPECT_EQ(load.error(), "the load 'cpu' can't be started: No such file or directory");
}

} // namespace

} // namespace tactus::hrtc::test
