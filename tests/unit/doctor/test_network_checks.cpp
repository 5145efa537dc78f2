// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/doctor/network_checks.hpp"
#include "tests/unit/doctor/made_up_machine.hpp"

#include <gtest/gtest.h>

namespace tactus::doctor
{

namespace
{

constexpr const char* kOnEth0 =
    R"(<CycloneDDS><Domain><General><Interfaces><NetworkInterface name="eth0"/></Interfaces>)";

class NetworkChecks : public testing::Test
{
protected:
    NetworkChecks() { make_good(machine); }

    void put_state(const std::string& name, const char* flags, const char* state) const
    {
        machine.put("/sys/class/net/" + name + "/flags", flags);
        machine.put("/sys/class/net/" + name + "/operstate", state);
    }

    MadeUpMachine machine;
};

TEST_F(NetworkChecks, configuration_is_good_unless_a_file_of_it_is_missing)
{
    EXPECT_EQ(check_dds_configuration(machine.view()).found, "CYCLONEDDS_URI is not set");
    machine.put("/etc/dds.xml", kOnEth0);
    machine.measured.dds_uri = "file:///etc/dds.xml";
    Finding sut = check_dds_configuration(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::good);
    EXPECT_EQ(sut.found, "CYCLONEDDS_URI is 'file:///etc/dds.xml'");
    machine.take_away("/etc/dds.xml");
    sut = check_dds_configuration(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::critical);
    EXPECT_TRUE(sut.found.ends_with("; '/etc/dds.xml' can't be read"));
    EXPECT_TRUE(sut.remedy.at(0).starts_with("unset CYCLONEDDS_URI"));
}

TEST_F(NetworkChecks, loopback_is_what_counts_without_a_configuration)
{
    put_state("eth0", "0x1002", "down");
    EXPECT_EQ(check_dds_interface(machine.view()).verdict, Verdict::good);
    EXPECT_EQ(check_dds_interface(machine.view()).found, "'lo' is up");
    put_state("lo", "0x8", "down");
    const Finding sut = check_dds_interface(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::critical);
    EXPECT_EQ(sut.found, "'lo' is down");
    EXPECT_EQ(sut.remedy, std::vector<std::string>{"sudo ip link set dev 'lo' up"});
}

TEST_F(NetworkChecks, a_named_interface_must_be_there_on_and_linked)
{
    machine.measured.dds_uri = kOnEth0;
    EXPECT_EQ(check_dds_interface(machine.view()).verdict, Verdict::good);
    put_state("eth0", "0x1003", "down");
    EXPECT_EQ(check_dds_interface(machine.view()).found, "'eth0' is up without a link");
    EXPECT_EQ(check_dds_interface(machine.view()).verdict, Verdict::critical);
    EXPECT_EQ(check_dds_interface(machine.view()).remedy,
              std::vector<std::string>{"ip link show dev 'eth0' # No carrier: the cable?"});
    put_state("eth0", "0x1002", "down");
    EXPECT_EQ(check_dds_interface(machine.view()).found, "'eth0' is down");
    put_state("eth0", "0x1002", "unknown"); // As a tunnel that is off.
    EXPECT_EQ(check_dds_interface(machine.view()).found, "'eth0' is down");
    EXPECT_EQ(check_dds_interface(machine.view()).verdict, Verdict::critical);
    put_state("eth0", "many", "up");
    EXPECT_EQ(check_dds_interface(machine.view()).found, "'eth0' does not tell its state");
    EXPECT_EQ(check_dds_interface(machine.view()).verdict, Verdict::unknown);
    machine.take_away("/sys/class/net/eth0");
    EXPECT_EQ(check_dds_interface(machine.view()).found, "'eth0' is not there");
    EXPECT_EQ(check_dds_interface(machine.view()).verdict, Verdict::critical);
}

TEST_F(NetworkChecks, of_several_named_interfaces_the_worst_counts)
{
    machine.measured.dds_uri = "<NetworkInterface name='lo'/><NetworkInterface "
                               "name='eth1'/><NetworkInterface name='eth0'/>";
    put_state("eth0", "", "up");
    const Finding sut = check_dds_interface(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::critical);
    EXPECT_EQ(sut.found, "'lo' is up; 'eth1' is not there; 'eth0' does not tell its state");
    EXPECT_EQ(sut.remedy.size(), 2U);
}

TEST_F(NetworkChecks, without_a_name_any_interface_with_a_network_will_do)
{
    machine.measured.dds_uri = "<CycloneDDS/>";
    EXPECT_EQ(check_dds_interface(machine.view()).found, "no interface is named; 'eth0' is up");
    put_state("eth0", "0x1002", "down");
    Finding sut = check_dds_interface(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::advice);
    EXPECT_EQ(sut.remedy, std::vector<std::string>{"sudo ip link set dev 'eth0' up"});
    put_state("lo", "0x8", "down");
    sut = check_dds_interface(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::critical);
    EXPECT_EQ(sut.found, "no interface is up");
    machine.take_away("/sys/class/net/eth0");
    EXPECT_EQ(check_dds_interface(machine.view()).remedy.at(0),
              "ip -brief link # None but the loopback is there.");
}

TEST_F(NetworkChecks, an_interface_can_have_an_unpleasant_name)
{
    machine.measured.dds_uri = R"(<NetworkInterface name="a'; reboot"/>)";
    put_state("a'; reboot", "0x1002", "down");
    EXPECT_EQ(check_dds_interface(machine.view()).remedy,
              std::vector<std::string>{R"(sudo ip link set dev 'a'\''; reboot' up)"});
}

TEST_F(NetworkChecks, buffers_have_the_sizes_that_dds_asks_for)
{
    EXPECT_EQ(check_dds_buffers(machine.view()).verdict, Verdict::good);
    machine.put("/proc/sys/net/core/rmem_max", "1048575\n");
    machine.put("/proc/sys/net/core/wmem_max", "65536\n");
    machine.put("/etc/sysctl.d/60-tactus.conf", "");
    Finding sut = check_dds_buffers(machine.view());
    EXPECT_EQ(sut.verdict, Verdict::advice);
    ASSERT_EQ(sut.remedy.size(), 2U);
    EXPECT_EQ(sut.remedy[1], "sudo sysctl --system");
    machine.put("/proc/sys/net/core/wmem_max", "65535\n");
    sut = check_dds_buffers(machine.view());
    ASSERT_EQ(sut.remedy.size(), 3U);
    machine.run(sut.remedy[0]);
    machine.run(sut.remedy[1]);
    EXPECT_EQ(machine.content_of("/etc/sysctl.d/60-tactus.conf"),
              "net.core.rmem_max=1048576\nnet.core.wmem_max=65536\n");
    machine.put("/proc/sys/net/core/wmem_max", "-1\n");
    EXPECT_EQ(check_dds_buffers(machine.view()).verdict, Verdict::unknown);
}

} // namespace

} // namespace tactus::doctor
