// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/keys/options.hpp"

#include "platform/program/command_line.hpp"
#include "transport/base/printable.hpp"
#include "transport/dds/key_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tactus::keys
{

namespace
{

constexpr std::size_t kNameMost = 40;

struct Names
{
    std::vector<std::string> servers;
    std::vector<std::string> controllers;
    std::vector<std::string> viewers;
};

void declare_options(CommandLine& line, Site& site, Names& names)
{
    line.add_version("tactus-keys " TACTUS_VERSION);
    line.begin_task("The site", "tactus-keys --domain 7 --servers station --controllers hand-1");
    line.add_option_file("--config", "TOML file of these options, as hrtc's: domain = 7, servers = "
                                     "[\"station\"], controllers = [\"hand-1\", \"hand-2\"]");
    line.add_option("--domain", site.domain, "The DDS domain that is protected")
        .integer_between(std::uint32_t{0}, dds::kMaxSecuredDomain)
        .show_default();
    line.add_option("--servers", names.servers,
                    "Names that may serve models and scenes (spm_publish), and watch")
        .repeatable_with_more();
    line.add_option("--controllers", names.controllers,
                    "Names that may touch (hrtc): each requests and reads in partitions of its own "
                    "name alone")
        .repeatable_with_more();
    line.add_option("--viewers", names.viewers, "Names that may watch controllers (spm_view)")
        .repeatable_with_more();
    line.begin_task("The keys", "tactus-keys --config site.toml --revoke hand-1");
    line.add_option("--days", site.days, "How long certificates, rights and the CRL are good")
        .integer_between(std::uint32_t{1}, std::uint32_t{3'650})
        .show_default();
    line.add_option("--renew", site.renewed, "Names that get a new key and certificate")
        .repeatable_with_more()
        .not_in_file();
    line.add_option("--revoke", site.revoked,
                    "Names whose certificates count no more where the new CRL is; who is still of "
                    "the site gets new ones")
        .repeatable_with_more()
        .not_in_file();
    line.begin_task("Where they are", "tactus-keys --config site.toml --authority /media/usb/ca");
    line.add_option("--authority", site.authority,
                    "Folder of the certificate authorities, made where it is missing; keep it "
                    "apart from all machines. Another one makes all keys new")
        .show_default();
    line.add_option("--output", site.output,
                    "Folder that gets NAME/ and NAME.tar for each name; the tar is for "
                    "/etc/tactus of its machine")
        .show_default();
    line.add_log_options();
}

/// As in a certificate, a permission's pattern and a file's name. A dot would let 'a' read what is
/// for 'a.b'.
bool is_plain_name(std::string_view name)
{
    return !name.empty() && name.size() <= kNameMost &&
           std::ranges::all_of(name,
                               [](char c)
                               {
                                   return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                                          (c >= '0' && c <= '9') || c == '_' || c == '-';
                               });
}

/// Empty when all is well.
std::string take_members(Site& site, const Names& names)
{
    const std::pair<Role, const std::vector<std::string>*> roles[] = {
        {Role::server, &names.servers},
        {Role::controller, &names.controllers},
        {Role::viewer, &names.viewers}};
    std::set<std::string> taken;
    for (const auto& [role, of_role] : roles)
    {
        for (const std::string& name : *of_role)
        {
            if (!is_plain_name(name))
            {
                return fmt::format("--{}s: '{}' is not 1 to {} characters of A-Z a-z 0-9 _ -",
                                   name_of(role), printable(name), kNameMost);
            }
            if (!taken.insert(name).second)
            {
                return fmt::format("--{}s: '{}' is given twice; each name has one role",
                                   name_of(role), name);
            }
            site.members.push_back({role, name});
        }
    }
    for (const std::string& name : site.renewed)
    {
        if (!taken.contains(name))
        {
            return fmt::format("--renew: '{}' is not of the site", printable(name));
        }
    }
    return site.members.empty() ? "no name is given: --servers, --controllers or --viewers" : "";
}

} // namespace

std::variant<Site, int> parse_options(CommandLine& line, int argc, char** argv)
{
    Site site;
    Names names;
    declare_options(line, site, names);
    if (const auto code = line.parse(argc, argv))
    {
        return *code;
    }
    if (const std::string fault = take_members(site, names); !fault.empty())
    {
        return line.fail(fault, kExitUsage);
    }
    return site;
}

} // namespace tactus::keys
