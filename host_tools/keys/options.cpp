// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/keys/site.hpp"
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
    std::vector<std::string> editors;
};

void declare_options(CommandLine& line, Site& site, Names& names)
{
    line.add_version("tactus-keys " TACTUS_VERSION);
    line.begin_task("The site", "tactus-keys --domain 7 --servers station --controllers hand-1");
    line.add_option_file("--config",
                         "TOML file of these options, for example: domain = 7, servers = "
                         "[\"station\"], controllers = [\"hand-1\", \"hand-2\"]");
    line.add_option("--domain", site.domain, "DDS domain of the site")
        .integer_between(std::uint32_t{0}, dds::kMaxSecuredDomain)
        .show_default();
    line.add_option("--servers", names.servers,
                    "Names of servers (spm_publish): they serve models and scenes, and may watch")
        .repeatable_with_more();
    line.add_option("--controllers", names.controllers,
                    "Names of controllers (hrtc): each requests and reads only in partitions of "
                    "its own name")
        .repeatable_with_more();
    line.add_option("--viewers", names.viewers,
                    "Names of viewers (spm_view): they may watch controllers")
        .repeatable_with_more();
    line.add_option("--editors", names.editors,
                    "Names of controllers that may also request edits of models (hrtc --edit)")
        .repeatable_with_more();
    line.begin_task("The keys", "tactus-keys --config site.toml --revoke hand-1");
    line.add_option("--days", site.days, "Validity of certificates, rights and the CRL, in days")
        .integer_between(std::uint32_t{1}, std::uint32_t{3'650})
        .show_default();
    line.add_option("--renew", site.renewed, "Names that get a new key and a new certificate")
        .repeatable_with_more()
        .not_in_file();
    line.add_option("--revoke", site.revoked,
                    "Names whose present certificates are put on the CRL, which every machine "
                    "needs then; a "
                    "name that is still of the site gets a new certificate")
        .repeatable_with_more()
        .not_in_file();
    line.begin_task("Folders", "tactus-keys --config site.toml --authority /media/usb/ca");
    line.add_option(
            "--authority", site.authority,
            "Folder of the certificate authorities, made if it is missing. Keep it away from the "
            "machines that run programs. With another folder, all keys are new")
        .show_default();
    line.add_option(
            "--output", site.output,
            "Folder for NAME/ and NAME.tar of each name; unpack the archive in /etc of its machine")
        .show_default();
    line.add_log_options();
}

/// True if the name can stand in a certificate, a pattern of a permission and a file name. With a
/// dot, controller 'a' could read the pieces of 'a.b'.
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

/// Returns the fault of the names, or an empty text.
std::string take_members(Site& site, const Names& names)
{
    const std::pair<Role, const std::vector<std::string>*> roles[] = {
        {Role::server, &names.servers},
        {Role::controller, &names.controllers},
        {Role::viewer, &names.viewers},
        {Role::editor, &names.editors}};
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
    return site.members.empty() ? "no name is given: --servers, --controllers, --viewers or "
                                  "--editors"
                                : "";
}

} // namespace

std::variant<Site, int> parse_options(CommandLine& line, int argc, char** argv)
{
    Site site;
    Names names;
    declare_options(line, site, names);
    if (const auto code = line.parse(argc, argv, [&] { return take_members(site, names); }))
    {
        return *code;
    }
    return site;
}

} // namespace tactus::keys
