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
    server,     ///< Serves models and scenes, and watches.
    controller, ///< Requests and reads, in partitions of its name.
    viewer,     ///< Reads telemetry and refinement states.
};

/// In the order of Role.
[[nodiscard]] const char* name_of(Role role) noexcept;

/// The document that protects a domain: peers without a certificate are refused, and all but the
/// announcement of a participant is encrypted.
[[nodiscard]] std::string governance(std::uint32_t domain);

/// The document of what the certificate of that name may do on the domain, and nothing else.
[[nodiscard]] std::string permissions(Role role, const std::string& name, std::uint32_t domain,
                                      std::time_t from, std::time_t until);

} // namespace tactus::keys
