// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"
#include "transport/dds/openssl_handles.hpp"

#include <ctime>
#include <string>

namespace tactus::keys
{

inline constexpr std::time_t kDay_s = 24 * 3'600;

/// A certificate with its private key.
struct Identity
{
    openssl::Certificate certificate;
    openssl::Key key;
};

/// The two certificate authorities of a site, for identities and for permissions, in one folder.
/// Cyclone accepts a permissions document signed by any certificate below its permissions
/// authority; with one authority a controller could sign rights for itself.
///
/// The folder also has the list of revoked certificates (crl.pem), and all issued certificates
/// without their keys (issued/).
class Authority
{
public:
    /// Makes the folder if it is missing, with authorities that are valid for ten years from `now`.
    /// Refused if a file can't be read or written, if other users can't be kept out, if the folder
    /// has other files only, and if an authority has ended.
    [[nodiscard]] static Result<Authority, Refusal> open(const std::string& folder,
                                                         std::time_t now);

    /// Makes a key and a certificate for CN=`name`.
    [[nodiscard]] Result<Identity, Refusal> issue(const std::string& name, std::time_t from,
                                                  std::time_t until);
    /// Revokes every certificate of that name; refused if there is none.
    [[nodiscard]] Result<Done, Refusal> revoke(const std::string& name, std::time_t now);
    /// Signs the list of revoked certificates for another period.
    [[nodiscard]] Result<Done, Refusal> renew_crl(std::time_t from, std::time_t until);

    /// True if the certificate is of this authority for CN=`name`, belongs to the key, has not
    /// expired and is not revoked.
    [[nodiscard]] bool vouches_for(const Identity& identity, const std::string& name,
                                   std::time_t now) const;
    /// End of the authorities, the earlier.
    [[nodiscard]] std::time_t until() const noexcept { return until_; }
    /// The document in S/MIME, signed by the permissions authority; empty on failure.
    [[nodiscard]] std::string sign(const std::string& document) const;

    /// Certificates and list in PEM, for every machine.
    [[nodiscard]] std::string identity_ca() const;
    [[nodiscard]] std::string permissions_ca() const;
    [[nodiscard]] std::string crl() const;

private:
    Authority() = default;

    std::string folder_;
    Identity identities_;
    Identity permissions_;
    openssl::Crl crl_;
    std::time_t until_{};
};

/// End of the certificate's validity.
[[nodiscard]] std::time_t end_of(const X509* certificate);

/// The object in PEM.
[[nodiscard]] std::string text_of(X509* certificate);
[[nodiscard]] std::string text_of(EVP_PKEY* key);
[[nodiscard]] std::string text_of(X509_CRL* crl);

} // namespace tactus::keys
