// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <array>
#include <cstdint>
#include <ctime>
#include <string>

namespace tactus::dds
{

/// Cyclone takes no higher domain in governance and permissions.
inline constexpr std::uint32_t kMaxSecuredDomain = 230;

inline constexpr const char* kIdentityCaFile = "identity_ca.pem";
inline constexpr const char* kPermissionsCaFile = "permissions_ca.pem";
inline constexpr const char* kIdentityFile = "identity.pem";
inline constexpr const char* kKeyFile = "identity.key"; ///< The one that is secret.
inline constexpr const char* kGovernanceFile = "governance.p7s";
inline constexpr const char* kPermissionsFile = "permissions.p7s";
inline constexpr const char* kCrlFile = "crl.pem";
inline constexpr std::array kKeyFiles{kIdentityCaFile, kPermissionsCaFile, kIdentityFile, kKeyFile,
                                      kGovernanceFile, kPermissionsFile,   kCrlFile};

/// The keys of one program on a protected domain: a folder with all of kKeyFiles.
struct KeyFolder
{
    std::string path;          ///< Absolute.
    std::string name;          ///< Of the certificate: a controller's is its name on the domain.
    std::time_t valid_until{}; ///< When the certificate or the CRL ends.
};

/// Refused in one line: a file that is missing or broken; a private key that other users may read
/// or that isn't the certificate's; at the time `now` a certificate or CRL that isn't valid yet or
/// any more, or a certificate that is revoked or another authority's; rights that were changed or
/// are for other domains than `domain`; and domains above 230.
[[nodiscard]] Result<KeyFolder, Refusal> read_key_folder(const std::string& path,
                                                         std::uint32_t domain, std::time_t now);

/// By which lines and reports call the certificate of that name: 12 hexadecimal digits, with which
/// its participants' GUIDs begin (Participants::certificate_of()).
[[nodiscard]] std::string certificate_digits(const std::string& name);

} // namespace tactus::dds
