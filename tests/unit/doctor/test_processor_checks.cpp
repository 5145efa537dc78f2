// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/doctor/processor_checks.hpp"
#include "tests/unit/doctor/made_up_machine.hpp"

#include <gtest/gtest.h>

namespace tactus::doctor
{

namespace
{

constexpr const char* kFolder = "/sys/devices/system/cpu/";

class ProcessorChecks : public testing::Test
{
protected:
    ProcessorChecks() { make_good(machine); }

    void put(const std::string& path, const std::string& content) const
    {
        machine.put(kFolder + path, content);
    }

    MadeUpMachine machine;
};

TEST_F(ProcessorChecks, governor_of_another_processor_does_not_matter)
{
    put("cpu0/cpufreq/scaling_governor", "powersave\n");
    EXPECT_EQ(check_governor(machine.view()).verdict, Verdict::good);
    machine.cpu.reset();
    const Finding sut = check_governor(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::advice);
    EXPECT_EQ(sut.found, "processors 1-3: performance; processor 0: powersave");
}

TEST_F(ProcessorChecks, governor_is_mended_on_the_chosen_processor_or_on_all)
{
    for (const bool chosen : {true, false})
    {
        put("cpu1/cpufreq/scaling_governor", "schedutil\n");
        put("cpu3/cpufreq/scaling_governor", "ondemand\n");
        machine.cpu = chosen ? std::optional(3) : std::nullopt;
        const Finding sut = check_governor(machine.view());
        ASSERT_EQ(sut.verdict, Verdict::advice);
        machine.run(sut.remedy.at(0));
        EXPECT_EQ(check_governor(machine.view()).verdict, Verdict::good);
        EXPECT_EQ(machine.content_of("/sys/devices/system/cpu/cpu1/cpufreq/scaling_governor"),
                  chosen ? "schedutil\n" : "performance\n");
    }
}

TEST_F(ProcessorChecks, governor_that_is_not_there_is_no_fault)
{
    for (const std::string cpu : {"cpu0", "cpu1", "cpu2", "cpu3"})
    {
        machine.take_away(kFolder + cpu + "/cpufreq");
    }
    machine.cpu.reset();
    const Finding sut = check_governor(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::good);
    EXPECT_EQ(sut.found,
              "processors 0-3 without a governor: the clock is fixed, or the hypervisor's");
}

TEST_F(ProcessorChecks, governor_of_garbage_is_unknown)
{
    for (const char* text :
         {"", "PERFORMANCE", "performance now", "\x1b[2J", "averyveryverylongname"})
    {
        put("cpu3/cpufreq/scaling_governor", text);
        EXPECT_EQ(check_governor(machine.view()).verdict, Verdict::unknown) << text;
    }
}

TEST_F(ProcessorChecks, idle_states_count_up_to_the_deepest_that_is_on)
{
    put("cpu3/cpuidle/state2/latency", "50\n");
    put("cpu3/cpuidle/state2/disable", "0\n");
    put("cpu3/cpuidle/state3/latency", "890\n");
    put("cpu3/cpuidle/state3/disable", "1\n");
    const Finding sut = check_idle_states(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::good);
    EXPECT_EQ(sut.found, "driver 'intel_idle', up to 50 us to wake");
    put("cpu3/cpuidle/state2/latency", "51\n");
    EXPECT_EQ(check_idle_states(machine.view()).verdict, Verdict::advice);
}

TEST_F(ProcessorChecks, idle_states_are_switched_off_by_what_mends_them)
{
    for (const std::string state : {"state2", "state3"})
    {
        put("cpu2/cpuidle/" + state + "/latency", "200\n");
        put("cpu2/cpuidle/" + state + "/disable", "0\n");
    }
    EXPECT_EQ(check_idle_states(machine.view()).verdict, Verdict::good); // On 3.
    machine.cpu.reset();
    const Finding sut = check_idle_states(machine.view());
    ASSERT_EQ(sut.verdict, Verdict::advice);
    machine.run(sut.remedy.at(0));
    EXPECT_EQ(check_idle_states(machine.view()).verdict, Verdict::good);
    EXPECT_EQ(machine.content_of("/sys/devices/system/cpu/cpu2/cpuidle/state1/disable"), "0\n");
}

TEST_F(ProcessorChecks, idle_states_may_be_held_by_another_process)
{
    put("cpu3/cpuidle/state2/latency", "890\n");
    EXPECT_EQ(check_idle_states(machine.view()).verdict, Verdict::advice);
    machine.put("/dev/cpu_dma_latency", std::string("\x0a\0\0\0", 4));
    const Finding sut = check_idle_states(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::good);
    EXPECT_EQ(sut.found, "driver 'intel_idle', up to 890 us to wake, held to 10 us by "
                         "/dev/cpu_dma_latency");
    for (const std::string& garbage :
         {std::string(), std::string("0"), std::string("\xff\xff\xff\xff"), std::string(9, '\0')})
    {
        machine.put("/dev/cpu_dma_latency", garbage);
        EXPECT_EQ(check_idle_states(machine.view()).verdict, Verdict::advice);
    }
}

TEST_F(ProcessorChecks, idle_states_of_garbage_are_unknown)
{
    for (const char* text : {"", "-1", "deep", "1 2"})
    {
        put("cpu3/cpuidle/state1/latency", text);
        const Finding sut = check_idle_states(machine.view());
        EXPECT_EQ(sut.verdict, Verdict::unknown) << text;
        EXPECT_NE(sut.found.find("cpu3/cpuidle/state1/latency"), std::string::npos);
    }
}

TEST_F(ProcessorChecks, siblings_of_the_chosen_processor_are_named)
{
    put("cpu3/topology/thread_siblings_list", "1,3\n");
    const Finding sut = check_siblings(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::advice);
    EXPECT_EQ(sut.found, "processor 3 shares its core with 1");
    EXPECT_EQ(sut.remedy,
              std::vector<std::string>{"echo 0 | sudo tee /sys/devices/system/cpu/cpu1/online"});
}

TEST_F(ProcessorChecks, siblings_that_leave_out_the_processor_itself_are_unknown)
{
    for (const char* text : {"", "1", "3-1", "x"})
    {
        put("cpu3/topology/thread_siblings_list", text);
        EXPECT_EQ(check_siblings(machine.view()).verdict, Verdict::unknown) << text;
    }
}

TEST_F(ProcessorChecks, siblings_anywhere_matter_while_none_is_chosen)
{
    machine.cpu.reset();
    EXPECT_EQ(check_siblings(machine.view()).verdict, Verdict::good);
    put("smt/active", "1\n");
    const Finding sut = check_siblings(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::advice);
    EXPECT_EQ(sut.remedy,
              std::vector<std::string>{"echo off | sudo tee /sys/devices/system/cpu/smt/control"});
    put("smt/active", "2\n");
    EXPECT_EQ(check_siblings(machine.view()).verdict, Verdict::unknown);
}

} // namespace

} // namespace tactus::doctor
