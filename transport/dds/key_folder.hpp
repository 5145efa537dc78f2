// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <array>
#include <cstdint>
#include <ctime>
#include <string>

struct dds_qos; // Cyclone's.

namespace tactus::dds
{

/// Largest domain that Cyclone accepts in governance and permissions.
inline constexpr std::uint32_t kMaxSecuredDomain = 230;

inline constexpr const char* kIdentityCaFile = "identity_ca.pem";
inline constexpr const char* kPermissionsCaFile = "permissions_ca.pem";
inline constexpr const char* kIdentityFile = "identity.pem";
inline constexpr const char* kKeyFile = "identity.key"; ///< The secret file.
inline constexpr const char* kGovernanceFile = "governance.p7s";
inline constexpr const char* kPermissionsFile = "permissions.p7s";
inline constexpr const char* kCrlFile = "crl.pem";
inline constexpr std::array kKeyFiles{kIdentityCaFile, kPermissionsCaFile, kIdentityFile, kKeyFile,
                                      kGovernanceFile, kPermissionsFile,   kCrlFile};

/// Keys of one program on a protected domain: a folder with all of kKeyFiles.
struct KeyFolder
{
    std::string path; ///< Absolute path of the folder.
    std::string name; ///< Common name of the certificate; for a controller its name on the domain.
    std::time_t valid_until{}; ///< End of the certificate, its authorities or the CRL: the first.
};

/// Reads and checks a folder of keys. Refused in one line: a missing or broken file; a private key
/// that other users may read or that does not belong to the certificate; a folder or file that they
/// may change; a file with several certificates; a certificate or CRL that is not valid at `now`; a
/// certificate that is revoked or of another authority; documents that were changed, are not for
/// `domain` or give no rights to the certificate's name; domains above 230. Ordinary thread; reads
/// files.
[[nodiscard]] Result<KeyFolder, Refusal> read_key_folder(const std::string& path,
                                                         std::uint32_t domain, std::time_t now);

/// The 12 hexadecimal digits that stand for the certificate of that name in lines and reports. The
/// GUIDs of its participants begin with them (Participants::certificate_of()).
[[nodiscard]] std::string certificate_digits(const std::string& name);

/// Adds the three plugins of DDS Security, with these keys, to the QoS of a participant.
void protect(dds_qos* participant, const KeyFolder& keys);

/// True if a value of CYCLONEDDS_URI opens programs to a network without keys: it names another
/// interface than loopback, or none, and has no element <Security>. Also true if a named file is no
/// regular one of 1 byte to 1 MiB; false if one is missing, since Cyclone refuses that. Searches
/// the text and does not parse XML: elements count for every domain.
[[nodiscard]] bool is_open_to_network(const std::string& cyclonedds_uri);

} // namespace tactus::dds
