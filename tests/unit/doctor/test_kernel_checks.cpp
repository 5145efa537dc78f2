// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/doctor/kernel_checks.hpp"
#include "tests/unit/doctor/made_up_machine.hpp"

#include <gtest/gtest.h>

namespace tactus::doctor
{

namespace
{

constexpr const char* kGrub = "/etc/default/grub";

class KernelChecks : public testing::Test
{
protected:
    KernelChecks() { make_good(machine); }

    MadeUpMachine machine;
};

TEST_F(KernelChecks, preemption_is_good_by_either_sign)
{
    EXPECT_EQ(check_preemption(machine.view()).verdict, Verdict::good);
    machine.take_away("/sys/kernel/realtime");
    EXPECT_EQ(check_preemption(machine.view()).verdict, Verdict::good);
    machine.put("/sys/kernel/realtime", "1");
    machine.put("/proc/version", "Linux version 5.10 #1 SMP PREEMPT");
    EXPECT_EQ(check_preemption(machine.view()).verdict, Verdict::good);
}

TEST_F(KernelChecks, preemption_tells_the_kind_that_is_there)
{
    machine.take_away("/sys/kernel/realtime");
    machine.put("/proc/version", "Linux version 6.1 #1 SMP PREEMPT_DYNAMIC Debian");
    machine.put("/sys/kernel/debug/sched/preempt", "none (voluntary) full\n");
    const Finding sut = check_preemption(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::advice);
    EXPECT_EQ(sut.found, "the kernel has PREEMPT_DYNAMIC, not PREEMPT_RT, and runs as 'voluntary'");
    ASSERT_EQ(sut.remedy.size(), 2U);
    EXPECT_EQ(sut.remedy[0], "sudo apt-get install linux-image-rt-amd64 && sudo reboot");
    machine.run(sut.remedy[1]);
    EXPECT_EQ(machine.content_of("/sys/kernel/debug/sched/preempt"), "full\n");
}

TEST_F(KernelChecks, preemption_has_nothing_to_change_where_all_is_preempted)
{
    machine.take_away("/sys/kernel/realtime");
    machine.put("/proc/version", "Linux version 6.1 #1 SMP PREEMPT Debian");
    machine.put("/sys/kernel/debug/sched/preempt", "none voluntary (full)\n");
    machine.measured.machine = "aarch64";
    const Finding sut = check_preemption(machine.view());
    EXPECT_EQ(sut.found, "the kernel has PREEMPT, not PREEMPT_RT, and runs as 'full'");
    EXPECT_EQ(sut.remedy,
              std::vector<std::string>{"sudo apt-get install linux-image-rt-arm64 && sudo reboot"});
}

TEST_F(KernelChecks, preemption_falls_back_to_what_uname_tells)
{
    machine.take_away("/sys/kernel/realtime");
    machine.take_away("/proc/version");
    EXPECT_EQ(check_preemption(machine.view()).verdict, Verdict::good);
    machine.measured.kernel_version = "#1 SMP";
    const Finding sut = check_preemption(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::advice);
    EXPECT_EQ(sut.found, "the kernel has no kind of PREEMPT, not PREEMPT_RT");
    machine.measured.kernel_version = "";
    EXPECT_EQ(check_preemption(machine.view()).verdict, Verdict::unknown);
}

TEST_F(KernelChecks, throttling_judges_the_share)
{
    const std::vector<std::pair<const char*, Verdict>> cases{
        {"-1", Verdict::good},       {"1000000", Verdict::good},  {"2000000", Verdict::good},
        {"999999", Verdict::advice}, {"950000", Verdict::advice}, {"1", Verdict::advice},
        {"0", Verdict::critical},    {"-2", Verdict::unknown},    {"", Verdict::unknown},
        {"many", Verdict::unknown}};
    for (const auto& [runtime, verdict] : cases)
    {
        machine.put("/proc/sys/kernel/sched_rt_runtime_us", runtime);
        const Finding sut = check_throttling(machine.view());
        EXPECT_EQ(sut.verdict, verdict) << runtime;
        EXPECT_EQ(sut.remedy.empty(), verdict == Verdict::good) << runtime;
    }
}

TEST_F(KernelChecks, throttling_needs_a_period)
{
    machine.put("/proc/sys/kernel/sched_rt_runtime_us", "950000");
    for (const char* period : {"0", "-5", "x", ""})
    {
        machine.put("/proc/sys/kernel/sched_rt_period_us", period);
        const Finding sut = check_throttling(machine.view());
        EXPECT_EQ(sut.verdict, Verdict::unknown) << period;
        EXPECT_NE(sut.found.find("sched_rt_period_us"), std::string::npos) << sut.found;
    }
}

TEST_F(KernelChecks, compaction_must_leave_locked_memory_alone)
{
    EXPECT_EQ(check_compaction(machine.view()).found, "locked memory stays where it is");
    for (const auto& [allowed, verdict] :
         {std::pair("1\n", Verdict::advice), std::pair("2", Verdict::advice),
          std::pair("", Verdict::unknown), std::pair("no", Verdict::unknown)})
    {
        machine.put("/proc/sys/vm/compact_unevictable_allowed", allowed);
        const Finding sut = check_compaction(machine.view());
        EXPECT_EQ(sut.verdict, verdict) << allowed;
        EXPECT_FALSE(sut.remedy.empty());
    }
}

TEST_F(KernelChecks, isolation_is_good_for_an_isolated_processor)
{
    EXPECT_EQ(check_isolation(machine.view()).found, "processor 3 is isolated, without a tick");
    machine.put("/sys/devices/system/cpu/nohz_full", "(null)\n");
    const Finding sut = check_isolation(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::good);
    EXPECT_EQ(sut.found, "processor 3 is isolated, with a tick");
}

TEST_F(KernelChecks, isolation_of_another_processor_is_none)
{
    machine.cpu = 2;
    EXPECT_EQ(check_isolation(machine.view()).verdict, Verdict::advice);
    machine.cpu.reset();
    const Finding sut = check_isolation(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::advice);
    EXPECT_EQ(sut.remedy, std::vector<std::string>{"hrtc doctor --cpu 3 # And hrtc --cpu 3."});
}

TEST_F(KernelChecks, isolation_is_asked_for_on_the_kernels_line)
{
    machine.put("/sys/devices/system/cpu/isolated", "\n");
    machine.put(kGrub, "GRUB_TIMEOUT=5\nGRUB_CMDLINE_LINUX=\"quiet\"\n");
    const Finding sut = check_isolation(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::advice);
    ASSERT_EQ(sut.remedy.size(), 1U);
    EXPECT_TRUE(sut.remedy[0].ends_with(" && sudo update-grub && sudo reboot"));
    machine.run(sut.remedy[0]);
    EXPECT_EQ(machine.content_of(kGrub),
              "GRUB_TIMEOUT=5\nGRUB_CMDLINE_LINUX=\"isolcpus=managed_irq,domain,3 nohz_full=3 "
              "rcu_nocbs=3 irqaffinity=0-2 quiet\"\n");
}

TEST_F(KernelChecks, isolation_takes_two_processors)
{
    machine.put("/sys/devices/system/cpu/isolated", "");
    machine.put("/sys/devices/system/cpu/online", "0");
    machine.cpu = 0;
    const Finding sut = check_isolation(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::advice);
    EXPECT_NE(sut.remedy.at(0).find("needs another"), std::string::npos);
}

TEST_F(KernelChecks, interrupts_are_counted_where_they_really_go)
{
    EXPECT_EQ(check_interrupts(machine.view()).found,
              "0 of 1 interrupts go to processor 3; new ones do not");
    machine.put("/proc/irq/24/effective_affinity_list", "3\n");
    const Finding sut = check_interrupts(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::advice);
    EXPECT_EQ(sut.found, "1 of 1 interrupts go to processor 3 (24 'eth0'); new ones do not");
}

TEST_F(KernelChecks, interrupts_that_serve_no_device_do_not_count)
{
    machine.put("/proc/irq/9/smp_affinity_list", "0-3\n");
    EXPECT_EQ(check_interrupts(machine.view()).verdict, Verdict::good);
}

TEST_F(KernelChecks, interrupts_are_moved_by_what_mends_them)
{
    machine.take_away("/proc/irq/24/effective_affinity_list"); // It would follow by itself.
    for (const std::string number : {"24", "25", "26", "27"})
    {
        machine.put("/proc/irq/" + number + "/smp_affinity_list", "0-3\n");
        machine.put_folder("/proc/irq/" + number + "/disk");
    }
    machine.put("/proc/irq/default_smp_affinity", "f\n");
    machine.put("/usr/sbin/irqbalance", "");
    const Finding sut = check_interrupts(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::advice);
    EXPECT_EQ(sut.found, "4 of 4 interrupts go to processor 3 (24 'disk', 25 'disk', 26 'disk', "
                         "...); new ones may");
    ASSERT_EQ(sut.remedy.size(), 3U);
    EXPECT_EQ(sut.remedy[0], "sudo systemctl disable --now irqbalance");
    machine.run(sut.remedy[1]);
    machine.run(sut.remedy[2]);
    EXPECT_EQ(check_interrupts(machine.view()).verdict, Verdict::good);
}

TEST_F(KernelChecks, interrupts_of_which_nothing_is_told_are_not_called_good)
{
    machine.put("/proc/irq/24/effective_affinity_list", "?");
    machine.put("/proc/irq/24/smp_affinity_list", "");
    const Finding sut = check_interrupts(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::unknown);
    EXPECT_TRUE(sut.found.ends_with("of 1 the kernel does not tell")) << sut.found;
    machine.put("/proc/irq/default_smp_affinity", "f\n");
    EXPECT_EQ(check_interrupts(machine.view()).verdict, Verdict::advice);
}

TEST_F(KernelChecks, interrupts_want_a_processor_to_be_chosen)
{
    machine.cpu.reset();
    const Finding sut = check_interrupts(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::advice);
    EXPECT_EQ(sut.remedy, std::vector<std::string>{"hrtc doctor --cpu 3"});
}

TEST_F(KernelChecks, interrupts_have_nowhere_else_to_go_on_one_processor)
{
    machine.cpu = 0;
    machine.put("/sys/devices/system/cpu/online", "0");
    machine.put("/proc/irq/default_smp_affinity", "1");
    EXPECT_EQ(check_interrupts(machine.view()).remedy,
              std::vector<std::string>{"lscpu --online --extended # One is too few."});
}

} // namespace

} // namespace tactus::doctor
