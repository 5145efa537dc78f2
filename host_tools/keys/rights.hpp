// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>
#include <ctime>
#include <string>

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

} // namespace tactus::keys
