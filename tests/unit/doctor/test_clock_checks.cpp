// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/doctor/clock_checks.hpp"
#include "tests/unit/doctor/made_up_machine.hpp"

#include <gtest/gtest.h>

namespace tactus::doctor
{

namespace
{

constexpr const char* kCurrent = "/sys/devices/system/clocksource/clocksource0/current_clocksource";
constexpr const char* kAvailable =
    "/sys/devices/system/clocksource/clocksource0/available_clocksource";

class ClockChecks : public testing::Test
{
protected:
    ClockChecks() { make_good(machine); }

    MadeUpMachine machine;
};

TEST_F(ClockChecks, source_is_judged_by_the_calls_that_were_counted)
{
    machine.put(kCurrent, "xen\n"); // Its name alone does not tell.
    EXPECT_EQ(check_clock_source(machine.view()).verdict, Verdict::good);
    EXPECT_EQ(check_clock_source(machine.view()).found, "'xen', 0 system calls in 64 reads");
    machine.measured.clock_calls = 64;
    const Finding sut = check_clock_source(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::critical);
    EXPECT_EQ(sut.found, "'xen', 64 system calls in 64 reads");
}

TEST_F(ClockChecks, source_is_judged_by_its_name_where_calls_can_not_be_counted)
{
    machine.measured.clock_calls.reset();
    for (const char* name : {"tsc", "kvm-clock", "arch_sys_counter", "hyperv_clocksource_tsc_page"})
    {
        machine.put(kCurrent, name);
        EXPECT_EQ(check_clock_source(machine.view()).verdict, Verdict::good) << name;
    }
    for (const char* name : {"hpet", "acpi_pm", "jiffies", "refined-jiffies"})
    {
        machine.put(kCurrent, name);
        EXPECT_EQ(check_clock_source(machine.view()).verdict, Verdict::critical) << name;
    }
    for (const char* name : {"xen", "", "tsc hpet", "sundial"})
    {
        machine.put(kCurrent, name);
        EXPECT_EQ(check_clock_source(machine.view()).verdict, Verdict::unknown) << name;
    }
}

TEST_F(ClockChecks, source_need_not_be_told_when_calls_were_counted)
{
    machine.take_away(kCurrent);
    EXPECT_EQ(check_clock_source(machine.view()).verdict, Verdict::good);
    machine.measured.clock_calls.reset();
    EXPECT_EQ(check_clock_source(machine.view()).verdict, Verdict::unknown);
}

TEST_F(ClockChecks, a_better_source_is_taken_by_what_mends_it)
{
    machine.measured.clock_calls.reset();
    machine.put(kCurrent, "hpet\n");
    machine.put(kAvailable, "hpet kvm-clock tsc acpi_pm \n");
    machine.run(check_clock_source(machine.view()).remedy.at(0));
    EXPECT_EQ(machine.content_of(kCurrent), "tsc\n");
    EXPECT_EQ(check_clock_source(machine.view()).verdict, Verdict::good);
}

TEST_F(ClockChecks, where_there_is_no_better_source_the_kernel_is_asked_for_one)
{
    machine.measured.clock_calls = 64;
    machine.put(kCurrent, "tsc\n"); // As some hypervisors have it.
    machine.put(kAvailable, "tsc hpet acpi_pm\n");
    EXPECT_NE(check_clock_source(machine.view()).remedy.at(0).find("clocksource=tsc tsc=reliable"),
              std::string::npos);
    machine.measured.machine = "aarch64";
    EXPECT_TRUE(check_clock_source(machine.view()).remedy.at(0).starts_with("dmesg"));
}

TEST_F(ClockChecks, timer_must_be_finer_than_a_tick)
{
    machine.measured.clock_resolution_ns = 1'000;
    EXPECT_EQ(check_timer(machine.view()).verdict, Verdict::good);
    machine.measured.clock_resolution_ns = 1'001;
    EXPECT_EQ(check_timer(machine.view()).verdict, Verdict::critical);
    machine.measured.clock_resolution_ns = 4'000'000;
    EXPECT_TRUE(check_timer(machine.view()).remedy.at(0).starts_with("grep HIGH_RES_TIMERS"));
    for (const auto& untold : {std::optional<std::int64_t>(), std::optional<std::int64_t>(0),
                               std::optional<std::int64_t>(-1)})
    {
        machine.measured.clock_resolution_ns = untold;
        EXPECT_EQ(check_timer(machine.view()).verdict, Verdict::unknown);
    }
}

TEST_F(ClockChecks, timer_that_was_made_coarse_is_mended_on_the_kernels_line)
{
    machine.measured.clock_resolution_ns = 4'000'000;
    machine.put("/proc/cmdline", "quiet highres=off\n");
    machine.put("/etc/default/grub", "GRUB_CMDLINE_LINUX=\"highres=off quiet\"\n");
    machine.run(check_timer(machine.view()).remedy.at(0));
    EXPECT_EQ(machine.content_of("/etc/default/grub"), "GRUB_CMDLINE_LINUX=\" quiet\"\n");
}

TEST_F(ClockChecks, float_control_that_was_changed_is_critical)
{
    EXPECT_EQ(check_float_control(machine.view()).verdict, Verdict::good);
    machine.measured.float_control_is_default = false;
    Finding sut = check_float_control(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::critical);
    EXPECT_NE(sut.remedy.at(0).find("ldmxcsr"), std::string::npos);
    machine.measured.preloaded = "fast.so";
    sut = check_float_control(machine.view());
    EXPECT_TRUE(sut.found.ends_with("LD_PRELOAD is 'fast.so'"));
    EXPECT_EQ(sut.remedy, std::vector<std::string>{"unset LD_PRELOAD"});
}

} // namespace

} // namespace tactus::doctor
