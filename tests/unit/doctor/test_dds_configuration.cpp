// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/doctor/checks.hpp"
#include "tests/unit/doctor/made_up_machine.hpp"

#include <gtest/gtest.h>

namespace tactus::doctor
{

namespace
{

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
