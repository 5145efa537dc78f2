// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/keys/site.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <set>
#include <string>
#include <string_view>

namespace tactus
{
namespace
{

/// What a document allows, as "publish TOPIC PARTITION" with the topic's last word.
std::set<std::string> rights_in(const std::string& document)
{
    std::set<std::string> rights;
    const auto text_of = [&](std::string_view tag, std::size_t at)
    {
        const std::size_t begin = document.find(tag, at) + tag.size();
        return document.substr(begin, document.find('<', begin) - begin);
    };
    for (const std::string verb : {"publish", "subscribe"})
    {
        for (std::size_t at = 0; (at = document.find("<" + verb + ">", at)) != std::string::npos;
             ++at)
        {
            const std::string topic = text_of("<topic>", at);
            rights.insert(verb + topic.substr(topic.rfind('/')) + " " + text_of("<partition>", at));
        }
    }
    return rights;
}

std::set<std::string> rights_of(keys::Role role, const std::string& name)
{
    return rights_in(keys::permissions(role, name, 7, 0, 86'400));
}

} // namespace

/// What Cyclone makes of the documents is shown by hostile.dds_security.
TEST(Rights, are_the_least_of_each_role)
{
    const std::set<std::string> watching{"subscribe/telemetry *"};
    EXPECT_EQ(rights_of(keys::Role::viewer, "desk"), watching);
    EXPECT_EQ(rights_of(keys::Role::controller, "hand-1"),
              (std::set<std::string>{"publish/wanted hand-1", "publish/telemetry hand-1",
                                     "subscribe/catalogue ", "subscribe/chunks hand-1.*",
                                     "subscribe/objects server.*", "subscribe/motion server.*",
                                     "subscribe/edits server.*"}));
    EXPECT_EQ(
        rights_of(keys::Role::server, "station"),
        (std::set<std::string>{"publish/catalogue ", "publish/chunks *", "publish/objects server.*",
                               "publish/motion server.*", "publish/edits server.*",
                               "subscribe/catalogue ", "subscribe/wanted *",
                               "subscribe/telemetry *", "subscribe/edit_requests server.*"}));
    EXPECT_EQ(rights_of(keys::Role::editor, "desk-2"),
              (std::set<std::string>{"publish/wanted desk-2", "publish/telemetry desk-2",
                                     "publish/edit_requests server.*", "subscribe/catalogue ",
                                     "subscribe/chunks desk-2.*", "subscribe/objects server.*",
                                     "subscribe/motion server.*", "subscribe/edits server.*"}));
}

TEST(Rights, are_for_one_certificate_and_its_time)
{
    const std::string document = keys::permissions(keys::Role::controller, "hand-1", 7, 0, 86'400);
    EXPECT_NE(document.find("<subject_name>CN=hand-1</subject_name>"), std::string::npos);
    EXPECT_NE(document.find("<not_before>1970-01-01T00:00:00</not_before>"
                            "<not_after>1970-01-02T00:00:00</not_after>"),
              std::string::npos);
}

/// A controller could otherwise send motion to another one in the server's name.
TEST(Rights, nothing_is_accepted_from_another_reader_in_the_writers_name)
{
    const std::string document = keys::governance(7);
    for (const char* kind : {"discovery", "liveliness", "metadata"})
    {
        const std::string element = std::string(kind) + "_protection_kind>";
        EXPECT_NE(document.find("<" + element + "ENCRYPT_WITH_ORIGIN_AUTHENTICATION</" + element),
                  std::string::npos)
            << kind;
    }
}

} // namespace tactus
