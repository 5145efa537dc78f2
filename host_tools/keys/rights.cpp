// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/keys/rights.hpp"

#include "transport/dds/topics.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <ctime>
#include <span>
#include <string>
#include <string_view>

namespace tactus::keys
{

namespace
{

/// A topic, and a pattern of partitions in which {} is the certificate's name.
struct Right
{
    const char* topic;
    const char* partition;
};

// Partitions as transport/dds/topics.hpp names them.
constexpr const char* kAny = "*";
constexpr const char* kUnnamed = "";
constexpr const char* kOfServers = "server.*";
constexpr const char* kOwn = "{}";
constexpr const char* kOwnPieces = "{}.*";

/// Topics of edits, in the partitions of servers.
constexpr const char* kEditRequests = "edit_requests";
constexpr const char* kEdits = "edits";

constexpr std::array kServerWrites{Right{"catalogue", kUnnamed}, Right{"chunks", kAny},
                                   Right{"objects", kOfServers}, Right{"motion", kOfServers},
                                   Right{kEdits, kOfServers}};
constexpr std::array kServerReads{Right{"catalogue", kUnnamed}, Right{"wanted", kAny},
                                  Right{"telemetry", kAny}, Right{kEditRequests, kOfServers}};
constexpr std::array kControllerWrites{Right{"wanted", kOwn}, Right{"telemetry", kOwn}};
constexpr std::array kControllerReads{Right{"catalogue", kUnnamed}, Right{"chunks", kOwnPieces},
                                      Right{"objects", kOfServers}, Right{"motion", kOfServers},
                                      Right{kEdits, kOfServers}};
constexpr std::array kEditorWrites{Right{"wanted", kOwn}, Right{"telemetry", kOwn},
                                   Right{kEditRequests, kOfServers}};
constexpr std::array kViewerReads{Right{"telemetry", kAny}};

struct Rights
{
    const char* role;
    std::span<const Right> writes;
    std::span<const Right> reads;
};
constexpr std::array<Rights, 4> kRights{{{"server", kServerWrites, kServerReads},
                                         {"controller", kControllerWrites, kControllerReads},
                                         {"viewer", {}, kViewerReads},
                                         {"editor", kEditorWrites, kControllerReads}}};

constexpr std::string_view kDocument = R"(<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">
{}</dds>
)";

/// All readers of a writer have its keys: without authentication of the origin, one of them could
/// send to the others in the writer's name.
constexpr std::string_view kGovernance = R"(<domain_access_rules><domain_rule>
<domains><id>{}</id></domains>
<allow_unauthenticated_participants>false</allow_unauthenticated_participants>
<enable_join_access_control>true</enable_join_access_control>
<discovery_protection_kind>ENCRYPT_WITH_ORIGIN_AUTHENTICATION</discovery_protection_kind>
<liveliness_protection_kind>ENCRYPT_WITH_ORIGIN_AUTHENTICATION</liveliness_protection_kind>
<rtps_protection_kind>NONE</rtps_protection_kind>
<topic_access_rules><topic_rule>
<topic_expression>*</topic_expression>
<enable_discovery_protection>true</enable_discovery_protection>
<enable_liveliness_protection>true</enable_liveliness_protection>
<enable_read_access_control>true</enable_read_access_control>
<enable_write_access_control>true</enable_write_access_control>
<metadata_protection_kind>ENCRYPT_WITH_ORIGIN_AUTHENTICATION</metadata_protection_kind>
<data_protection_kind>NONE</data_protection_kind>
</topic_rule></topic_access_rules>
</domain_rule></domain_access_rules>
)";

constexpr std::string_view kGrant = R"(<permissions><grant name="{0}">
<subject_name>CN={0}</subject_name>
<validity><not_before>{1}</not_before><not_after>{2}</not_after></validity>
<allow_rule>
<domains><id>{3}</id></domains>
{4}{5}</allow_rule>
<default>DENY</default>
</grant></permissions>
)";

std::string criteria(const char* element, std::span<const Right> rights, const std::string& name)
{
    std::string text;
    for (const Right& right : rights)
    {
        text += fmt::format("<{0}><topics><topic>tactus/v{1}/{2}</topic></topics>"
                            "<partitions><partition>{3}</partition></partitions></{0}>\n",
                            element, dds::kProtocolVersion, right.topic,
                            fmt::format(fmt::runtime(right.partition), name));
    }
    return text;
}

std::string xml_time(std::time_t time)
{
    return fmt::format("{:%Y-%m-%dT%H:%M:%S}", fmt::gmtime(time));
}

} // namespace

const char* name_of(Role role) noexcept
{
    return kRights[static_cast<std::size_t>(role)].role;
}

std::string governance(std::uint32_t domain)
{
    return fmt::format(kDocument, fmt::format(kGovernance, domain));
}

std::string permissions(Role role, const std::string& name, std::uint32_t domain, std::time_t from,
                        std::time_t until)
{
    const Rights& rights = kRights[static_cast<std::size_t>(role)];
    return fmt::format(kDocument, fmt::format(kGrant, name, xml_time(from), xml_time(until), domain,
                                              criteria("publish", rights.writes, name),
                                              criteria("subscribe", rights.reads, name)));
}

} // namespace tactus::keys
