// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/keys/site.hpp"

#include "host_tools/keys/authority.hpp"
#include "transport/base/atomic_file.hpp"
#include "transport/dds/key_folder.hpp"
#include "transport/dds/topics.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <sys/stat.h>
#include <system_error>
#include <utility>

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

namespace
{

struct ArchivedFile
{
    std::string name; ///< At most 99 bytes; in an archive with its folders below /etc.
    std::string bytes;
    bool is_secret{false}; ///< Mode 0600, else 0644.
};

constexpr std::size_t kBlock = 512;

/// Header of a file in the ustar format of POSIX.1-1988.
std::string header(const std::string& name, std::size_t bytes, unsigned mode, char type,
                   std::time_t time)
{
    std::string block(kBlock, '\0');
    const auto put = [&block](std::size_t at, std::string_view text)
    { std::ranges::copy(text, block.begin() + static_cast<std::ptrdiff_t>(at)); };
    put(0, name.substr(0, 99));
    put(100, fmt::format("{:07o}", mode));
    put(108, fmt::format("{:07o}", 0)); // User and group: root.
    put(116, fmt::format("{:07o}", 0));
    put(124, fmt::format("{:011o}", bytes));
    put(136, fmt::format("{:011o}", time));
    put(148, "        "); // Blanks stand for the checksum while it is computed.
    block[156] = type;
    put(257, std::string_view("ustar\0"
                              "00",
                              8));
    put(265, "root");
    put(297, "root");
    unsigned sum = 0;
    for (const char byte : block)
    {
        sum += static_cast<unsigned char>(byte);
    }
    put(148, fmt::format("{:06o}", sum));
    block[154] = '\0';
    return block;
}

/// A tar archive (ustar) of a folder and of these files, all of the user root.
std::string archive(const std::string& folder, const std::vector<ArchivedFile>& files,
                    std::time_t time)
{
    std::string text = header(folder + "/", 0, 0755, '5', time);
    for (const ArchivedFile& file : files)
    {
        text += header(file.name, file.bytes.size(), file.is_secret ? 0600 : 0644, '0', time);
        text += file.bytes;
        text.append((kBlock - file.bytes.size() % kBlock) % kBlock, '\0');
    }
    return text.append(2 * kBlock, '\0');
}

namespace fs = std::filesystem;

/// Clocks of machines differ: validity begins a day before.
constexpr std::time_t kSlack_s = kDay_s;

/// During its lifetime, new files of the process are unreadable for other users.
class OwnFiles
{
public:
    OwnFiles() : before_(::umask(077)) {}
    OwnFiles(const OwnFiles&) = delete;
    OwnFiles& operator=(const OwnFiles&) = delete;
    ~OwnFiles() { ::umask(before_); }

private:
    mode_t before_;
};

struct Period
{
    std::time_t now;
    std::time_t from;
    std::time_t until;
};

/// Name of the systemd service of this role.
const char* service_of(Role role) noexcept
{
    switch (role)
    {
    case Role::server:
        return "spm_publish";
    case Role::viewer:
        return "spm_view";
    case Role::controller:
    case Role::editor:
        break;
    }
    return "hrtc";
}

/// Drop-in for systemd: the service, which has a separate user, gets the keys of this folder below
/// /etc, and refuses to run without them.
std::string drop_in(const std::string& folder)
{
    std::string text =
        "# A clock before the certificates is refused: systemd-time-wait-sync.service "
        "waits for the time.\n"
        "[Unit]\nAfter=time-sync.target\n[Service]\n"
        "Environment=\"KEYS=--security %d --require-security\"\n";
    for (const char* file : dds::kKeyFiles)
    {
        text += fmt::format("LoadCredential={0}:/etc/{1}/{0}\n", file, folder);
    }
    return text;
}

/// Archive of these keys and of the drop-in, to be unpacked in /etc.
std::string archive_of(const Member& member, std::vector<ArchivedFile> files, std::time_t now)
{
    const std::string folder = "tactus/keys/" + member.name;
    for (ArchivedFile& file : files)
    {
        file.name.insert(0, folder + "/");
    }
    files.push_back({fmt::format("systemd/system/{}.service.d/keys.conf", service_of(member.role)),
                     drop_in(folder)});
    return archive(folder, files, now);
}

bool has(const std::vector<std::string>& names, const std::string& name)
{
    return std::ranges::find(names, name) != names.end();
}

/// The present identity of the folder if it is still valid for this name, otherwise an empty one.
Identity kept_identity(const fs::path& folder, const std::string& name, const Authority& authority,
                       std::time_t now)
{
    Identity identity{openssl::read_certificate(folder / dds::kIdentityFile),
                      openssl::read_key(folder / dds::kKeyFile)};
    const bool is_kept =
        identity.certificate && identity.key && authority.vouches_for(identity, name, now);
    return is_kept ? std::move(identity) : Identity{};
}

std::optional<Refusal> write_files(const fs::path& folder, const std::vector<ArchivedFile>& files,
                                   const std::string& archive)
{
    std::error_code error;
    fs::create_directories(folder, error);
    fs::permissions(folder, fs::perms::owner_all, error);
    if (error)
    {
        return Refusal{fmt::format("--output: {}: {}", folder.string(), error.message())};
    }
    std::optional<Refusal> refusal;
    for (const ArchivedFile& file : files)
    {
        refusal = refusal ? refusal : write_text(file.bytes, folder / file.name);
    }
    return refusal ? refusal : write_text(archive, folder.string() + ".tar");
}

Result<IssuedKeys, Refusal> make_member(const Site& site, const Member& member,
                                        Authority& authority, const Period& period)
{
    const fs::path folder = fs::path(site.output) / member.name;
    Identity identity;
    if (!has(site.renewed, member.name))
    {
        identity = kept_identity(folder, member.name, authority, period.now);
    }
    const bool is_new = !identity.certificate;
    if (is_new)
    {
        auto issued = authority.issue(member.name, period.from, period.until);
        if (!issued)
        {
            return issued.error();
        }
        identity = std::move(issued).value();
    }
    const std::string signed_governance = authority.sign(governance(site.domain));
    const std::string rights = authority.sign(
        permissions(member.role, member.name, site.domain, period.from, period.until));
    if (signed_governance.empty() || rights.empty())
    {
        return Refusal{fmt::format("the rights of '{}' can't be signed", member.name)};
    }
    const std::vector<ArchivedFile> files{{dds::kIdentityCaFile, authority.identity_ca()},
                                          {dds::kPermissionsCaFile, authority.permissions_ca()},
                                          {dds::kIdentityFile, text_of(identity.certificate.get())},
                                          {dds::kKeyFile, text_of(identity.key.get()), true},
                                          {dds::kGovernanceFile, signed_governance},
                                          {dds::kPermissionsFile, rights},
                                          {dds::kCrlFile, authority.crl()}};
    if (const auto refusal = write_files(folder, files, archive_of(member, files, period.now)))
    {
        return *refusal;
    }
    return IssuedKeys{member, folder.string() + ".tar", end_of(identity.certificate.get()), is_new};
}

} // namespace

Result<std::vector<IssuedKeys>, Refusal> make_keys(const Site& site, std::time_t now)
{
    [[maybe_unused]] const OwnFiles own;
    auto authority = Authority::open(site.authority, now);
    if (!authority)
    {
        return authority.error();
    }
    const Period period{now, now - kSlack_s,
                        std::min(now + std::time_t{site.days} * kDay_s, authority.value().until())};
    for (const std::string& name : site.revoked)
    {
        if (const auto revoked = authority.value().revoke(name, now); !revoked)
        {
            return revoked.error();
        }
    }
    if (const auto renewed = authority.value().renew_crl(period.from, period.until); !renewed)
    {
        return renewed.error();
    }
    std::vector<IssuedKeys> made;
    for (const Member& member : site.members)
    {
        auto keys = make_member(site, member, authority.value(), period);
        if (!keys)
        {
            return keys.error();
        }
        made.push_back(std::move(keys).value());
    }
    return made;
}

} // namespace tactus::keys
