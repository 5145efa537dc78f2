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

/// The two certificate authorities of a site, of identities and of permissions, in a folder of
/// their own. Two, since Cyclone takes a document that any certificate below its permissions
/// authority has signed: with one authority a controller could sign rights for itself.
///
/// Beside them lie the list of what is revoked (crl.pem) and, below issued/, each certificate
/// without its key.
class Authority
{
public:
    /// Makes the folder where it is missing, with keys that are good for ten years from `now`.
    [[nodiscard]] static Result<Authority, Refusal> open(const std::string& folder,
                                                         std::time_t now);

    /// A new key and certificate for CN=`name`.
    [[nodiscard]] Result<Identity, Refusal> issue(const std::string& name, std::time_t from,
                                                  std::time_t until);
    /// Revokes every certificate of that name; refused when there is none.
    [[nodiscard]] Result<Done, Refusal> revoke(const std::string& name, std::time_t now);
    /// Signs the list of what is revoked for another time.
    [[nodiscard]] Result<Done, Refusal> renew_crl(std::time_t from, std::time_t until);

    /// Whether it is of this authority, has not ended and is not revoked.
    [[nodiscard]] bool vouches_for(const Identity& identity, std::time_t now) const;
    /// The document in S/MIME, signed by the authority of permissions; empty when that fails.
    [[nodiscard]] std::string sign(const std::string& document) const;

    /// In PEM, for every machine.
    [[nodiscard]] std::string identity_ca() const;
    [[nodiscard]] std::string permissions_ca() const;
    [[nodiscard]] std::string crl() const;

private:
    Authority() = default;

    std::string folder_;
    Identity identities_;
    Identity permissions_;
    openssl::Crl crl_;
};

/// In PEM.
[[nodiscard]] std::string text_of(X509* certificate);
[[nodiscard]] std::string text_of(EVP_PKEY* key);
[[nodiscard]] std::string text_of(X509_CRL* crl);

} // namespace tactus::keys
