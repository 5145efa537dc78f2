// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/keys/authority.hpp"

#include "transport/base/atomic_file.hpp"
#include "transport/base/printable.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <openssl/bn.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>
#include <optional>
#include <system_error>
#include <utility>

namespace tactus::keys
{

namespace
{

namespace fs = std::filesystem;
using namespace openssl;

constexpr std::time_t kAuthorityDays = 3'650;
constexpr int kSerialBits = 127;

constexpr const char* kIdentityCa = "identity_ca";
constexpr const char* kPermissionsCa = "permissions_ca";
constexpr const char* kCrl = "crl.pem";
constexpr const char* kIssued = "issued";

using Serial = std::unique_ptr<BIGNUM, Free<BN_free>>;

Refusal not_made(const std::string& what)
{
    return {fmt::format("{} can't be made: OpenSSL refuses", what)};
}

std::string bytes_of(BIO* memory)
{
    char* bytes = nullptr;
    const long size = BIO_get_mem_data(memory, &bytes);
    return {bytes, static_cast<std::size_t>(size)};
}

bool set_times(X509* certificate, std::time_t from, std::time_t until)
{
    return ASN1_TIME_set(X509_getm_notBefore(certificate), from) != nullptr &&
           ASN1_TIME_set(X509_getm_notAfter(certificate), until) != nullptr;
}

bool set_random_serial(X509* certificate)
{
    const Serial number(BN_new());
    return BN_rand(number.get(), kSerialBits, BN_RAND_TOP_ANY, BN_RAND_BOTTOM_ANY) == 1 &&
           BN_to_ASN1_INTEGER(number.get(), X509_get_serialNumber(certificate)) != nullptr;
}

bool add_extension(X509* certificate, int kind, const char* value)
{
    X509_EXTENSION* extension = X509V3_EXT_conf_nid(nullptr, nullptr, kind, value);
    const bool is_added = extension != nullptr && X509_add_ext(certificate, extension, -1) == 1;
    X509_EXTENSION_free(extension);
    return is_added;
}

/// Makes an identity signed by `issuer`, or, if that is null, an authority signed by itself. The
/// certificate is null on failure.
Identity make_identity(const std::string& name, std::time_t from, std::time_t until,
                       const Identity* issuer)
{
    Identity made{Certificate(X509_new()), Key(EVP_PKEY_Q_keygen(nullptr, nullptr, "EC", "P-256"))};
    X509* certificate = made.certificate.get();
    const Name subject = subject_of(name);
    const Identity& signer = issuer != nullptr ? *issuer : made;
    const bool is_made =
        made.key && subject && X509_set_version(certificate, X509_VERSION_3) == 1 &&
        set_random_serial(certificate) && set_times(certificate, from, until) &&
        X509_set_subject_name(certificate, subject.get()) == 1 &&
        X509_set_issuer_name(certificate, X509_get_subject_name(signer.certificate.get())) == 1 &&
        X509_set_pubkey(certificate, made.key.get()) == 1 &&
        add_extension(certificate, NID_basic_constraints,
                      issuer == nullptr ? "critical,CA:TRUE,pathlen:0" : "critical,CA:FALSE") &&
        add_extension(certificate, NID_key_usage,
                      issuer == nullptr ? "critical,digitalSignature,keyCertSign,cRLSign"
                                        : "critical,digitalSignature") &&
        X509_sign(certificate, signer.key.get(), EVP_sha256()) > 0;
    if (!is_made)
    {
        made.certificate = nullptr;
    }
    return made;
}

std::string serial_text(const X509* certificate)
{
    const Serial number(ASN1_INTEGER_to_BN(X509_get0_serialNumber(certificate), nullptr));
    char* digits = BN_bn2hex(number.get());
    std::string text(digits);
    OPENSSL_free(digits);
    return text;
}

Result<Identity, Refusal> read_identity(const fs::path& folder, const std::string& name)
{
    const std::string path = folder / name;
    Identity identity{read_certificate(path + ".pem"), read_key(path + ".key")};
    if (!identity.certificate || !identity.key ||
        X509_check_private_key(identity.certificate.get(), identity.key.get()) != 1)
    {
        return Refusal{fmt::format("{0}.pem and {0}.key are no certificate with its key", path)};
    }
    return identity;
}

/// Makes the folder, which is closed to other users. One with other files is refused, since it
/// would be closed too.
std::optional<Refusal> open_folder(const std::string& folder)
{
    std::error_code error;
    const bool is_other = fs::is_directory(folder, error) && !fs::is_empty(folder, error) &&
                          !fs::exists(fs::path(folder) / kIssued, error);
    if (is_other)
    {
        return Refusal{fmt::format(
            "--authority: {} has other files and no authority; choose an empty folder", folder)};
    }
    fs::create_directories(fs::path(folder) / kIssued, error);
    if (error)
    {
        return Refusal{fmt::format("--authority: {}: {}", folder, error.message())};
    }
    fs::permissions(folder, fs::perms::owner_all, error);
    if (error)
    {
        return Refusal{fmt::format("--authority: {} can't be closed to other users ({}); choose a "
                                   "folder of a file system with access rights",
                                   folder, error.message())};
    }
    return std::nullopt;
}

Result<Identity, Refusal> open_identity(const fs::path& folder, const std::string& name,
                                        std::time_t now)
{
    const fs::path path = folder / (name + ".pem");
    std::error_code error;
    if (fs::exists(path, error))
    {
        return read_identity(folder, name);
    }
    Identity made =
        make_identity("tactus-" + name, now - kDay_s, now + kAuthorityDays * kDay_s, nullptr);
    if (!made.certificate)
    {
        return not_made(path.string());
    }
    auto refusal = write_text(text_of(made.key.get()), folder / (name + ".key"));
    refusal = refusal ? refusal : write_text(text_of(made.certificate.get()), path);
    if (refusal)
    {
        return *refusal;
    }
    return made;
}

bool is_revoked_by(X509_CRL* crl, X509* certificate)
{
    X509_REVOKED* entry = nullptr;
    return X509_CRL_get0_by_cert(crl, &entry, certificate) == 1;
}

bool add_revoked(X509_CRL* crl, X509* certificate, std::time_t now)
{
    X509_REVOKED* entry = X509_REVOKED_new();
    ASN1_TIME* when = ASN1_TIME_set(nullptr, now);
    const bool is_added =
        X509_REVOKED_set_serialNumber(entry, X509_get_serialNumber(certificate)) == 1 &&
        X509_REVOKED_set_revocationDate(entry, when) == 1 && X509_CRL_add0_revoked(crl, entry) == 1;
    ASN1_TIME_free(when);
    return is_added;
}

} // namespace

Result<Authority, Refusal> Authority::open(const std::string& folder, std::time_t now)
{
    if (const auto refusal = open_folder(folder))
    {
        return *refusal;
    }
    auto identities = open_identity(folder, kIdentityCa, now);
    auto permissions = open_identity(folder, kPermissionsCa, now);
    if (!identities || !permissions)
    {
        return identities ? permissions.error() : identities.error();
    }
    Authority authority;
    authority.folder_ = folder;
    authority.identities_ = std::move(identities).value();
    authority.permissions_ = std::move(permissions).value();
    authority.until_ = std::min(end_of(authority.identities_.certificate.get()),
                                end_of(authority.permissions_.certificate.get()));
    if (authority.until_ <= now)
    {
        return Refusal{fmt::format("--authority: the authority in {} ended {:%Y-%m-%d}; another "
                                   "folder gets a new one, and all keys change",
                                   folder, fmt::gmtime(authority.until_))};
    }
    std::error_code error;
    authority.crl_ = read_crl(fs::path(folder) / kCrl);
    if (!authority.crl_)
    {
        if (fs::exists(fs::path(folder) / kCrl, error))
        {
            return Refusal{fmt::format("{}/{} is no list of revoked certificates", folder, kCrl)};
        }
        authority.crl_.reset(X509_CRL_new());
        X509_CRL_set_version(authority.crl_.get(), X509_CRL_VERSION_2);
        X509_CRL_set_issuer_name(authority.crl_.get(),
                                 X509_get_subject_name(authority.identities_.certificate.get()));
    }
    return authority;
}

Result<Identity, Refusal> Authority::issue(const std::string& name, std::time_t from,
                                           std::time_t until)
{
    Identity made = make_identity(name, from, until, &identities_);
    if (!made.certificate)
    {
        return not_made("the certificate of '" + name + "'");
    }
    const fs::path path =
        fs::path(folder_) / kIssued / (name + "." + serial_text(made.certificate.get()) + ".pem");
    if (const auto refusal = write_text(text_of(made.certificate.get()), path))
    {
        return *refusal;
    }
    return made;
}

Result<Done, Refusal> Authority::revoke(const std::string& name, std::time_t now)
{
    std::size_t found = 0;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(fs::path(folder_) / kIssued, error))
    {
        if (!entry.path().filename().string().starts_with(name + "."))
        {
            continue;
        }
        const Certificate issued = read_certificate(entry.path());
        ++found;
        if (!issued || (!is_revoked_by(crl_.get(), issued.get()) &&
                        !add_revoked(crl_.get(), issued.get(), now)))
        {
            return Refusal{fmt::format("--revoke: {} can't be revoked", entry.path().string())};
        }
    }
    if (found == 0)
    {
        return Refusal{
            fmt::format("--revoke: '{}' has no certificate of {}", printable(name), folder_)};
    }
    return Done{};
}

Result<Done, Refusal> Authority::renew_crl(std::time_t from, std::time_t until)
{
    ASN1_TIME* begin = ASN1_TIME_set(nullptr, from);
    ASN1_TIME* end = ASN1_TIME_set(nullptr, until);
    const bool is_signed = X509_CRL_set1_lastUpdate(crl_.get(), begin) == 1 &&
                           X509_CRL_set1_nextUpdate(crl_.get(), end) == 1 &&
                           X509_CRL_sort(crl_.get()) == 1 &&
                           X509_CRL_sign(crl_.get(), identities_.key.get(), EVP_sha256()) > 0;
    ASN1_TIME_free(begin);
    ASN1_TIME_free(end);
    if (!is_signed)
    {
        return not_made(kCrl);
    }
    if (const auto refusal = write_text(crl(), fs::path(folder_) / kCrl))
    {
        return *refusal;
    }
    return Done{};
}

bool Authority::vouches_for(const Identity& identity, const std::string& name,
                            std::time_t now) const
{
    X509* certificate = identity.certificate.get();
    const Name subject = subject_of(name);
    return X509_verify(certificate, identities_.key.get()) == 1 &&
           X509_check_private_key(certificate, identity.key.get()) == 1 && subject &&
           X509_NAME_cmp(X509_get_subject_name(certificate), subject.get()) == 0 &&
           end_of(certificate) > now && !is_revoked_by(crl_.get(), certificate);
}

std::string Authority::sign(const std::string& document) const
{
    constexpr int kFlags = PKCS7_TEXT | PKCS7_DETACHED;
    const Bio in(BIO_new_mem_buf(document.data(), static_cast<int>(document.size())));
    const SignedText made(PKCS7_sign(permissions_.certificate.get(), permissions_.key.get(),
                                     nullptr, in.get(), kFlags));
    const Bio again(BIO_new_mem_buf(document.data(), static_cast<int>(document.size())));
    const Bio out(BIO_new(BIO_s_mem()));
    return made && SMIME_write_PKCS7(out.get(), made.get(), again.get(), kFlags) == 1
               ? bytes_of(out.get())
               : "";
}

std::string Authority::identity_ca() const
{
    return text_of(identities_.certificate.get());
}

std::string Authority::permissions_ca() const
{
    return text_of(permissions_.certificate.get());
}

std::string Authority::crl() const
{
    return text_of(crl_.get());
}

std::time_t end_of(const X509* certificate)
{
    std::tm parts{};
    return ASN1_TIME_to_tm(X509_get0_notAfter(certificate), &parts) == 1 ? timegm(&parts) : 0;
}

std::string text_of(X509* certificate)
{
    const Bio out(BIO_new(BIO_s_mem()));
    PEM_write_bio_X509(out.get(), certificate);
    return bytes_of(out.get());
}

std::string text_of(EVP_PKEY* key)
{
    const Bio out(BIO_new(BIO_s_mem()));
    PEM_write_bio_PrivateKey(out.get(), key, nullptr, nullptr, 0, nullptr, nullptr);
    return bytes_of(out.get());
}

std::string text_of(X509_CRL* crl)
{
    const Bio out(BIO_new(BIO_s_mem()));
    PEM_write_bio_X509_CRL(out.get(), crl);
    return bytes_of(out.get());
}

} // namespace tactus::keys
