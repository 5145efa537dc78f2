// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstdint>
#include <ctime>
#include <string>
#include <variant>
#include <vector>

namespace tactus
{
class CommandLine;
} // namespace tactus

namespace tactus::keys
{

enum class Role : std::uint8_t
{
    server,     ///< Serves models and scenes, and may watch.
    controller, ///< Requests and reads in partitions of its name.
    viewer,     ///< Reads telemetry and refinement states.
    editor,     ///< A controller that also requests edits of models.
};

/// Name of the role: "server", "controller", "viewer" or "editor".
[[nodiscard]] const char* name_of(Role role) noexcept;

/// Governance document (XML) of a domain: peers without a certificate are refused, and everything
/// except the announcement of a participant is encrypted.
[[nodiscard]] std::string governance(std::uint32_t domain);

/// Permissions document (XML) of the certificate with this name: the rights of the role on the
/// domain, and no others.
[[nodiscard]] std::string permissions(Role role, const std::string& name, std::uint32_t domain,
                                      std::time_t from, std::time_t until);

/// A program of a site, which gets keys of its own.
struct Member
{
    Role role{Role::server};
    std::string name;
};

/// The programs of a site, and the choices for their keys.
struct Site
{
    std::uint32_t domain{0};
    std::vector<Member> members;
    std::uint32_t days{365}; ///< Validity of certificates, rights and the CRL.
    std::string authority{"authority"};
    std::string output{"machines"};
    std::vector<std::string> renewed; ///< Names that get a new certificate.
    std::vector<std::string> revoked; ///< Names whose certificates are put on the CRL.
};

/// Result for one member.
struct IssuedKeys
{
    Member member;
    std::string archive;
    std::time_t until{};
    bool is_new{false};
};

/// Makes the certificates that are missing, expired or to be renewed; valid ones stay. Signs rights
/// and CRL for `days` from `now`, at most to the end of the authority. Writes a folder output/NAME
/// for each member, and an archive output/NAME.tar for /etc: the same files in tactus/keys/NAME/,
/// and a drop-in that gives them to the systemd service of the role. Refused if a file can't be
/// read or written.
[[nodiscard]] Result<std::vector<IssuedKeys>, Refusal> make_keys(const Site& site, std::time_t now);

/// Reads the command line and the option file. Returns the exit code if the program should end:
/// after --help, --version, or wrong usage, which gets one line on stderr.
[[nodiscard]] std::variant<Site, int> parse_options(CommandLine& line, int argc, char** argv);

} // namespace tactus::keys
