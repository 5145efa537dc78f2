// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/doctor/made_up_machine.hpp"

#include <gtest/gtest.h>

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

} // namespace

} // namespace tactus::doctor
