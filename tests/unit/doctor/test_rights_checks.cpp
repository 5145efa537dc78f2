// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/doctor/rights_checks.hpp"
#include "tests/unit/doctor/made_up_machine.hpp"

#include <gtest/gtest.h>

namespace tactus::doctor
{

namespace
{

constexpr const char* kLimits = "/etc/security/limits.d/tactus.conf";
constexpr const char* kHugePages = "/sys/kernel/mm/transparent_hugepage/enabled";

class RightsChecks : public testing::Test
{
protected:
    RightsChecks() { make_good(machine); }

    MadeUpMachine machine;
};

TEST_F(RightsChecks, priority_is_good_when_it_is_granted)
{
    machine.measured.rtprio_limit = 0;
    machine.put("/proc/self/status", "CapEff:\t0000000000800000\n"); // Bit 23 alone.
    const Finding sut = check_priority(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::good);
    EXPECT_EQ(sut.found, "SCHED_FIFO 81 granted; rtprio limit 0, CAP_SYS_NICE held");
    EXPECT_TRUE(sut.remedy.empty());
}

TEST_F(RightsChecks, priority_without_the_right_is_critical_and_asks_for_the_limit)
{
    machine.measured.fifo_refused = "EPERM";
    machine.measured.rtprio_limit = 80; // The supervisor has one more.
    machine.put("/etc/security/limits.d/tactus.conf", "");
    const Finding sut = check_priority(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::critical);
    EXPECT_EQ(sut.found, "SCHED_FIFO 81 refused (EPERM); rtprio limit 80, CAP_SYS_NICE not held");
    ASSERT_EQ(sut.remedy.size(), 2U);
    machine.run(sut.remedy[0]);
    EXPECT_EQ(machine.content_of(kLimits), "hand - rtprio 99\n");
}

TEST_F(RightsChecks, priority_refused_despite_the_right_is_the_groups_doing)
{
    machine.measured.fifo_refused = "EPERM";
    for (const bool by_limit : {true, false})
    {
        machine.measured.rtprio_limit = by_limit ? 81 : 0;
        machine.put("/proc/self/status", by_limit ? "CapEff:\t0\n" : "CapEff:\t0000000000800000\n");
        const Finding sut = check_priority(machine.view());
        EXPECT_EQ(sut.verdict, Verdict::critical);
        EXPECT_TRUE(sut.found.ends_with("the control group has no share of real time"));
        EXPECT_EQ(sut.remedy,
                  std::vector<std::string>{"echo 950000 | sudo tee "
                                           "'/sys/fs/cgroup/cpu/user.slice/cpu.rt_runtime_us'"});
    }
    machine.put("/proc/self/cgroup", "0::/user.slice\nnonsense\n:\n");
    EXPECT_TRUE(check_priority(machine.view())
                    .remedy.at(0)
                    .starts_with("echo $$ | sudo tee /sys/fs/cgroup/cgroup.procs"));
}

TEST_F(RightsChecks, capabilities_that_are_not_told_are_said_to_be_unknown)
{
    for (const char* status : {"", "CapEff:\t\n", "CapEff:\txyz\n", "CapPrm:\t00ff\n"})
    {
        machine.put("/proc/self/status", status);
        EXPECT_TRUE(
            check_priority(machine.view()).found.ends_with("CAP_SYS_NICE not known to be held"))
            << status;
    }
}

TEST_F(RightsChecks, memory_lock_is_judged_by_what_was_granted)
{
    EXPECT_EQ(check_memory_lock(machine.view()).found,
              "locking all memory granted; memlock limit unlimited, CAP_IPC_LOCK not held");
    machine.measured.memory_lock_granted = false;
    machine.measured.memlock_limit = 65'536;
    machine.measured.user = ":1000";
    machine.put(kLimits, "hand - rtprio 99\n");
    const Finding sut = check_memory_lock(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::critical);
    EXPECT_EQ(sut.found,
              "locking all memory refused; memlock limit 65536 bytes, CAP_IPC_LOCK not held");
    machine.run(sut.remedy.at(0));
    EXPECT_EQ(machine.content_of(kLimits), "hand - rtprio 99\n:1000 - memlock unlimited\n");
    machine.measured.memlock_limit.reset();
    EXPECT_NE(check_memory_lock(machine.view()).found.find("limit unknown,"), std::string::npos);
}

TEST_F(RightsChecks, huge_pages_are_judged_by_the_choice_in_brackets)
{
    const std::vector<std::pair<const char*, Verdict>> cases{
        {"always madvise [never]", Verdict::good},
        {"always [madvise] never", Verdict::good},
        {"[always] madvise never", Verdict::advice},
        {"always madvise never", Verdict::unknown},
        {"", Verdict::unknown},
        {"[sometimes]", Verdict::unknown}};
    for (const auto& [text, verdict] : cases)
    {
        machine.put(kHugePages, text);
        const Finding sut = check_huge_pages(machine.view());
        EXPECT_EQ(sut.verdict, verdict) << text;
        EXPECT_EQ(sut.remedy.empty(), verdict == Verdict::good) << text;
    }
    machine.put(kHugePages, "[always] madvise never");
    machine.run(check_huge_pages(machine.view()).remedy.at(0));
    EXPECT_EQ(machine.content_of(kHugePages), "madvise\n");
}

TEST_F(RightsChecks, a_kernel_without_huge_pages_is_good)
{
    machine.take_away("/sys/kernel/mm/transparent_hugepage");
    EXPECT_EQ(check_huge_pages(machine.view()).verdict, Verdict::good);
    machine.take_away("/sys/kernel/mm");
    EXPECT_EQ(check_huge_pages(machine.view()).verdict, Verdict::unknown);
}

} // namespace

} // namespace tactus::doctor
