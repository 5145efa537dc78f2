// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/temporary_folder.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/key_folder.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace tactus
{
namespace
{

std::string with_interfaces(const std::string& interfaces)
{
    return "<CycloneDDS><Domain id=\"any\"><General><Interfaces>" + interfaces +
           "</Interfaces></General></Domain></CycloneDDS>";
}

constexpr const char* kLoopback = "<NetworkInterface name=\"lo\" multicast=\"false\"/>";
constexpr const char* kNetwork = "<NetworkInterface name='eth0'/>";

} // namespace

TEST(NetworkSecurity, a_configuration_is_open_that_names_more_than_loopback)
{
    EXPECT_FALSE(dds::is_open_to_network(""));
    EXPECT_FALSE(dds::is_open_to_network(with_interfaces(kLoopback)));
    EXPECT_FALSE(dds::is_open_to_network(
        with_interfaces("<NetworkInterface multicast='true' address=\"127.0.0.1\"/>")));
    EXPECT_TRUE(dds::is_open_to_network(with_interfaces(kNetwork)));
    EXPECT_TRUE(dds::is_open_to_network(with_interfaces("<NetworkInterface address='10.0.0.1'/>")));
    EXPECT_TRUE(dds::is_open_to_network(
        with_interfaces("<NetworkInterface autodetermine='true' multicast='lo'/>")));
    EXPECT_TRUE(dds::is_open_to_network(with_interfaces(std::string(kLoopback) + kNetwork)));
    EXPECT_TRUE(dds::is_open_to_network("<CycloneDDS/>"));
    EXPECT_TRUE(dds::is_open_to_network("<!-- " + with_interfaces(kLoopback) + " -->" +
                                        with_interfaces(kNetwork)));
    EXPECT_TRUE(dds::is_open_to_network("<!-- <Security> -->" + with_interfaces(kNetwork)));
    EXPECT_FALSE(dds::is_open_to_network("<Security/>" + with_interfaces(kNetwork)));
}

/// Cyclone skips blanks and commas before each part, and the letters' case.
TEST(NetworkSecurity, a_configuration_is_read_as_cyclone_reads_it)
{
    EXPECT_TRUE(dds::is_open_to_network(" "));
    EXPECT_TRUE(dds::is_open_to_network("\n  " + with_interfaces(kNetwork)));
    EXPECT_TRUE(dds::is_open_to_network(" ,\t" + with_interfaces(kNetwork)));
    EXPECT_FALSE(dds::is_open_to_network("\n  " + with_interfaces(kLoopback) + "\n"));
    EXPECT_FALSE(dds::is_open_to_network(with_interfaces("<networkinterface\n\tNAME='lo'/>")));
    EXPECT_TRUE(dds::is_open_to_network(
        with_interfaces(std::string(kLoopback) + "<networkinterface name='eth0'/>")));
    EXPECT_TRUE(dds::is_open_to_network("<!-- a > , b -->" + with_interfaces(kNetwork)));
}

TEST(NetworkSecurity, the_files_of_a_configuration_are_looked_at)
{
    const test::TemporaryFolder folder("uri");
    const std::string loopback = folder.write("lo.xml", with_interfaces(kLoopback)).string();
    const std::string network = folder.write("net.xml", with_interfaces(kNetwork)).string();
    EXPECT_FALSE(dds::is_open_to_network(loopback));
    EXPECT_FALSE(dds::is_open_to_network("file://" + loopback));
    EXPECT_TRUE(dds::is_open_to_network("file://" + network));
    EXPECT_TRUE(dds::is_open_to_network("file://" + loopback + ",file://" + network));
    EXPECT_FALSE(dds::is_open_to_network("file://" + loopback + "-missing")); // Cyclone refuses.
    EXPECT_TRUE(dds::is_open_to_network(" file://" + network));
    EXPECT_TRUE(dds::is_open_to_network(with_interfaces(kLoopback) + " ,file://" + network));
    EXPECT_FALSE(dds::is_open_to_network(with_interfaces(kLoopback) + ",file://" + loopback));
    const std::string large =
        folder.write("large.xml", with_interfaces(kLoopback) + std::string(2U << 20U, ' '))
            .string();
    EXPECT_TRUE(dds::is_open_to_network("file://" + large));
}

TEST(NetworkSecurity, a_network_is_not_joined_without_keys_unless_that_is_asked_for)
{
    ::setenv("CYCLONEDDS_URI", with_interfaces(kNetwork).c_str(), 1);
    const auto refused = dds::Domain::join({5, NetworkSecurity{}});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().text,
              "CYCLONEDDS_URI names a network, and every program there can take part: use "
              "--security DIR for keys, or --plain to continue without");
    // Cyclone checks the presence of eth0.
    for (const auto& choice : {dds::DomainChoice{5, {"", true}}, dds::DomainChoice{5}})
    {
        const auto joined = dds::Domain::join(choice);
        EXPECT_TRUE(joined || joined.error().text.starts_with("DDS domain 5 cannot be joined"));
    }
    const auto no_keys = dds::Domain::join({5, NetworkSecurity{"no folder", false}});
    ASSERT_FALSE(no_keys);
    EXPECT_EQ(no_keys.error().text, "--security: no folder: is no folder");
    ::unsetenv("CYCLONEDDS_URI");
}

/// Loopback included, and a configuration with keys of its own, which are not checked.
TEST(NetworkSecurity, a_domain_is_not_joined_without_keys_that_are_required)
{
    const NetworkSecurity required{.keys = "", .is_plain = false, .is_required = true};
    for (const char* uri : {"", "<CycloneDDS><Domain><Security/></Domain></CycloneDDS>"})
    {
        ::setenv("CYCLONEDDS_URI", uri, 1);
        const auto refused = dds::Domain::join({5, required});
        ASSERT_FALSE(refused) << uri;
        EXPECT_EQ(refused.error().text, "--require-security: no keys are given; name their folder "
                                        "with --security DIR");
    }
    ::unsetenv("CYCLONEDDS_URI");
}

} // namespace tactus
