// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/doctor/checks.hpp"
#include "platform/diagnose/doctor/machine_view.hpp"
#include "tests/unit/doctor/made_up_machine.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <ctime>
#include <random>
#include <sched.h>
#include <sys/resource.h>

namespace tactus::doctor
{
namespace
{

TEST(SystemFiles, reads_below_its_root_alone)
{
    const MadeUpMachine machine;
    machine.put("/proc/version", " \nmade up\t\n\n");
    EXPECT_EQ(machine.files().text("/proc/version"), "made up");
    EXPECT_EQ(machine.files().bytes("/proc/version"), " \nmade up\t\n\n");
    EXPECT_FALSE(machine.files().text("/proc/cmdline"));
    EXPECT_FALSE(machine.files().is_there("/proc/cmdline"));
}

TEST(SystemFiles, reads_an_empty_file_as_an_empty_text)
{
    const MadeUpMachine machine;
    machine.put("/empty", "");
    machine.put("/white", " \n");
    machine.put("/nul", std::string(3, '\0'));
    EXPECT_EQ(machine.files().bytes("/empty"), "");
    EXPECT_EQ(machine.files().text("/empty"), "");
    EXPECT_EQ(machine.files().text("/white"), "");
    EXPECT_EQ(machine.files().text("/nul"), "");
}

TEST(SystemFiles, reads_the_beginning_of_a_huge_file)
{
    const MadeUpMachine machine;
    machine.put("/huge", std::string(3 * SystemFiles::kMostBytes, 'x'));
    EXPECT_EQ(machine.files().bytes("/huge")->size(), SystemFiles::kMostBytes);
}

TEST(SystemFiles, takes_no_folder_for_a_file)
{
    const MadeUpMachine machine;
    machine.put("/proc/irq/1/list", "0");
    EXPECT_FALSE(machine.files().bytes("/proc/irq"));
    EXPECT_FALSE(machine.files().text("/proc/irq"));
    EXPECT_TRUE(machine.files().is_folder("/proc/irq"));
    EXPECT_FALSE(machine.files().is_folder("/proc/irq/1/list"));
}

TEST(SystemFiles, lists_names_in_order)
{
    const MadeUpMachine machine;
    machine.put("/net/lo/flags", "");
    machine.put_folder("/net/eth0");
    machine.put("/net/file", "");
    EXPECT_EQ(machine.files().names("/net"), (std::vector<std::string>{"eth0", "file", "lo"}));
    EXPECT_TRUE(machine.files().names("/net/file").empty());
    EXPECT_TRUE(machine.files().names("/nowhere").empty());
}

TEST(SystemText, reads_integers_as_a_whole_or_not_at_all)
{
    EXPECT_EQ(parse_integer("-1"), -1);
    EXPECT_EQ(parse_integer("950000"), 950'000);
    for (const char* text : {"", "-", "1 ", "0x1", "1.5", "99999999999999999999", "one"})
    {
        EXPECT_FALSE(parse_integer(text)) << text;
    }
}

TEST(SystemText, reads_hexadecimal_with_and_without_its_sign)
{
    EXPECT_EQ(parse_hexadecimal("0x1003"), 0x1003U);
    EXPECT_EQ(parse_hexadecimal("000001fffeffffff"), 0x1fffeffffffU);
    for (const char* text : {"", "0x", "x1", "-1", "fffffffffffffffff", "0xg"})
    {
        EXPECT_FALSE(parse_hexadecimal(text)) << text;
    }
}

TEST(SystemText, reads_lists_of_processors)
{
    EXPECT_TRUE(parse_processor_list("")->none());
    EXPECT_EQ(parse_processor_list("0-2,5"), ProcessorSet(0b100111));
    EXPECT_TRUE(parse_processor_list("8191")->test(8191));
    for (const char* text :
         {",", "0,", "3-1", "-1", "1-", "8192", "0-99999999999", "a", "0 1", "(null)", "1--2"})
    {
        EXPECT_FALSE(parse_processor_list(text)) << text;
    }
}

TEST(SystemText, reads_masks_of_processors)
{
    EXPECT_EQ(parse_processor_mask("0000000b"), ProcessorSet(0b1011));
    EXPECT_TRUE(parse_processor_mask("1,00000000")->test(32));
    EXPECT_TRUE(parse_processor_mask("1,00000000")->count() == 1);
    std::string too_many = "1";
    for (std::size_t i = 0; i < kMostProcessors / 32; ++i)
    {
        too_many += ",00000000";
    }
    for (const std::string& text : {std::string(), std::string("1,"), std::string("1ffffffff"),
                                    std::string("g"), std::string("-1"), too_many})
    {
        EXPECT_FALSE(parse_processor_mask(text)) << text;
    }
}

TEST(SystemText, writes_what_it_reads)
{
    const unsigned seed = 20260101;
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    for (int i = 0; i < 200; ++i)
    {
        ProcessorSet set;
        for (int j = 0; j < i % 40 + 1; ++j)
        {
            set.set(random() % (i % 2 == 0 ? 70 : kMostProcessors));
        }
        EXPECT_EQ(parse_processor_list(processor_list(set)), set) << processor_list(set);
        EXPECT_EQ(parse_processor_mask(processor_mask(set)), set) << processor_mask(set);
        EXPECT_TRUE(set.test(static_cast<std::size_t>(lowest_of(set).value())));
        EXPECT_TRUE(set.test(static_cast<std::size_t>(highest_of(set).value())));
    }
}

TEST(SystemText, writes_no_processor_and_the_first_and_last)
{
    EXPECT_EQ(processor_list({}), "");
    EXPECT_EQ(processor_mask({}), "0");
    EXPECT_FALSE(lowest_of({}));
    EXPECT_FALSE(highest_of({}));
    const ProcessorSet ends = set_of(0) | set_of(33);
    EXPECT_EQ(processor_list(ends), "0,33");
    EXPECT_EQ(processor_mask(ends), "2,00000001");
    EXPECT_EQ(lowest_of(ends), 0);
    EXPECT_EQ(highest_of(ends), 33);
}

TEST(SystemText, finds_whole_words_only)
{
    EXPECT_TRUE(has_word("tsc hpet\tacpi_pm\n", "acpi_pm"));
    EXPECT_TRUE(has_word("tsc", "tsc"));
    EXPECT_FALSE(has_word("tsc-early hpet", "tsc"));
    EXPECT_FALSE(has_word("", "tsc"));
    EXPECT_FALSE(has_word("  ", "tsc"));
}

TEST(SystemText, shows_a_foreign_text_in_quotes)
{
    EXPECT_EQ(shown("a\x1b[2J\nb\xff"), "'a?[2J?b?'");
}

TEST(SystemText, makes_one_word_for_a_shell)
{
    EXPECT_EQ(shell_word("lo"), "'lo'");
    EXPECT_EQ(shell_word("a b;$(c)"), "'a b;$(c)'");
    EXPECT_EQ(shell_word("it's\n"), R"('it'\''s?')");
}

TEST(Measured, agrees_with_the_system)
{
    const Measured measured = measure();
    rlimit limit{};
    ASSERT_EQ(getrlimit(RLIMIT_RTPRIO, &limit), 0);
    EXPECT_EQ(measured.rtprio_limit, limit.rlim_cur);
    timespec resolution{};
    ASSERT_EQ(clock_getres(CLOCK_MONOTONIC, &resolution), 0);
    EXPECT_EQ(measured.clock_resolution_ns, resolution.tv_nsec);
    EXPECT_FALSE(measured.user.empty());
    EXPECT_FALSE(measured.machine.empty());
    EXPECT_FALSE(measured.kernel_version.empty());
    EXPECT_TRUE(measured.float_control_is_default);
    if (measured.clock_calls)
    {
        EXPECT_LE(*measured.clock_calls, Measured::kClockReads);
    }
}

TEST(Measured, finds_the_same_again_and_keeps_the_threads_policy)
{
    const Measured first = measure();
    const Measured second = measure();
    EXPECT_EQ(first.fifo_refused, second.fifo_refused);
    EXPECT_EQ(first.memory_lock_granted, second.memory_lock_granted);
    EXPECT_EQ(first.clock_calls, second.clock_calls);
    EXPECT_EQ(sched_getscheduler(0), SCHED_OTHER);
}

TEST(Measured, takes_the_configuration_of_dds_from_the_environment)
{
    ::setenv("CYCLONEDDS_URI", "<CycloneDDS/>", 1);
    EXPECT_EQ(measure().dds_uri, "<CycloneDDS/>");
    ::unsetenv("CYCLONEDDS_URI");
    EXPECT_EQ(measure().dds_uri, "");
}

TEST(Measured, tells_the_limit_of_locked_memory)
{
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_MEMLOCK, &before), 0);
    rlimit none = before;
    none.rlim_cur = 0;
    ASSERT_EQ(setrlimit(RLIMIT_MEMLOCK, &none), 0);
    const Measured measured = measure();
    ASSERT_EQ(setrlimit(RLIMIT_MEMLOCK, &before), 0);
    EXPECT_EQ(measured.memlock_limit, 0U);
}

using Names = std::vector<std::string>;

TEST(DdsConfiguration, finds_interfaces_by_name)
{
    const MadeUpMachine machine;
    const auto interfaces_of = [&machine](std::string_view uri)
    { return read_dds_configuration(uri, machine.files()).interfaces; };
    EXPECT_EQ(interfaces_of(R"(<NetworkInterface name="lo" multicast="false"/>)"), Names{"lo"});
    EXPECT_EQ(interfaces_of("<NetworkInterface\n priority='1'\tname = 'eth0' />"), Names{"eth0"});
    EXPECT_EQ(interfaces_of("<NetworkInterfaceAddress> eth1 </NetworkInterfaceAddress>"),
              Names{"eth1"});
    EXPECT_EQ(interfaces_of(R"(<NetworkInterface name="b"/>,<NetworkInterface name="a"/>)"
                            R"(<NetworkInterface name="b"/>)"),
              (Names{"b", "a"}));
}

TEST(DdsConfiguration, passes_over_what_names_none)
{
    const MadeUpMachine machine;
    for (const char* uri : {"",
                            " ",
                            ",,",
                            "<",
                            "<NetworkInterface",
                            "<NetworkInterface name",
                            "<NetworkInterface name=",
                            "<NetworkInterface name=\"lo",
                            "<NetworkInterface name=lo/>",
                            "<NetworkInterface/>",
                            "<NetworkInterface autodetermine=\"true\"/>",
                            "<NetworkInterface nickname=\"lo\"/>",
                            "<NetworkInterface address=\"10.0.0.1\"/>",
                            "<NetworkInterface name=\"\"/>",
                            "<NetworkInterface name=\"../lo\"/>",
                            "<NetworkInterface name=\"..\"/>",
                            "<!-- <NetworkInterface name=\"lo\"/> -->",
                            "<!-- <NetworkInterface name=\"lo\"/>",
                            "<NetworkInterfaceAddress>auto</NetworkInterfaceAddress>",
                            "<NetworkInterfaceAddress>"})
    {
        const DdsConfiguration sut = read_dds_configuration(uri, machine.files());
        EXPECT_TRUE(sut.interfaces.empty()) << uri;
        EXPECT_TRUE(sut.unreadable_file.empty()) << uri;
    }
}

TEST(DdsConfiguration, reads_files_before_elements)
{
    const MadeUpMachine machine;
    machine.put("/a.xml", "<NetworkInterface name=\"a\"/>");
    machine.put("/b.xml", "<NetworkInterface name=\"b\"/>");
    const DdsConfiguration sut = read_dds_configuration(
        "file:///a.xml, /b.xml,/gone.xml,/also.xml,<NetworkInterface name='c'/>", machine.files());
    EXPECT_EQ(sut.interfaces, (Names{"a", "b", "c"}));
    EXPECT_EQ(sut.unreadable_file, "/gone.xml");
}

} // namespace
} // namespace tactus::doctor
