// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/key_folder.hpp"

#include "transport/base/printable.hpp"
#include "transport/base/read_file.hpp"
#include "transport/dds/openssl_handles.hpp"
#include "transport/model_name.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <memory>
#include <openssl/sha.h>
#include <openssl/x509_vfy.h>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace tactus::dds
{

namespace
{

namespace fs = std::filesystem;
using namespace openssl;

/// Largest size of a file of certificates in bytes.
constexpr std::uintmax_t kCertificatesMost = 1U << 20U;

std::time_t time_of(const ASN1_TIME* time)
{
    std::tm parts{};
    return ASN1_TIME_to_tm(time, &parts) == 1 ? timegm(&parts) : 0;
}

std::string date_text(std::time_t time)
{
    return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(time));
}

std::string join_path(const std::string& folder, const char* file)
{
    return (fs::path(folder) / file).string();
}

std::string why_incomplete(const std::string& folder)
{
    std::error_code error;
    if (!fs::is_directory(folder, error))
    {
        return "is no folder";
    }
    std::vector<std::string_view> missing;
    std::ranges::copy_if(kKeyFiles, std::back_inserter(missing),
                         [&](const char* file)
                         { return !fs::exists(join_path(folder, file), error); });
    return missing.empty() ? "" : fmt::format("lacks {}", fmt::join(missing, ", "));
}

bool is_open_to_others(const std::string& path)
{
    std::error_code error;
    const fs::perms rights = fs::status(path, error).permissions();
    return !error && (rights & fs::perms::others_all) != fs::perms::none;
}

/// With another authority's certificate in the folder, its owner could be any server.
std::string why_changeable(const std::string& folder)
{
    std::error_code error;
    const auto is_changeable = [&](const std::string& path)
    {
        const fs::perms rights = fs::status(path, error).permissions();
        return !error && (rights & fs::perms::others_write) != fs::perms::none;
    };
    if (is_changeable(folder))
    {
        return "other users may change the folder; chmod o-w protects it";
    }
    const auto* const file = std::ranges::find_if(
        kKeyFiles, [&](const char* name) { return is_changeable(join_path(folder, name)); });
    return file == kKeyFiles.end()
               ? ""
               : fmt::format("other users may change {}; chmod o-w protects it", *file);
}

/// Text about the invalid one of certificate, authority and CRL.
std::string why_not_valid(const X509_STORE_CTX* context, const X509_CRL* crl, std::time_t now)
{
    const int error = X509_STORE_CTX_get_error(context);
    const X509* at = X509_STORE_CTX_get_current_cert(context);
    const char* file =
        X509_STORE_CTX_get_error_depth(context) == 0 ? kIdentityFile : kIdentityCaFile;
    constexpr const char* kClock = "the clock of this machine, {}, is before {}, which begins {}";
    switch (error)
    {
    case X509_V_ERR_CERT_NOT_YET_VALID:
        return fmt::format(kClock, date_text(now), file,
                           date_text(time_of(X509_get0_notBefore(at))));
    case X509_V_ERR_CRL_NOT_YET_VALID:
        return fmt::format(kClock, date_text(now), kCrlFile,
                           date_text(time_of(X509_CRL_get0_lastUpdate(crl))));
    case X509_V_ERR_CERT_HAS_EXPIRED:
        return fmt::format("{} ended {}", file, date_text(time_of(X509_get0_notAfter(at))));
    case X509_V_ERR_CRL_HAS_EXPIRED:
        return fmt::format("{} is too old: it ended {}", kCrlFile,
                           date_text(time_of(X509_CRL_get0_nextUpdate(crl))));
    case X509_V_ERR_UNABLE_TO_GET_CRL:
    case X509_V_ERR_CRL_SIGNATURE_FAILURE:
        return fmt::format("{} is not of {}", kCrlFile, kIdentityCaFile);
    case X509_V_ERR_CERT_REVOKED:
        return fmt::format("{} is revoked", kIdentityFile);
    default:
        return fmt::format("{} is not of {}: {}", kIdentityFile, kIdentityCaFile,
                           X509_verify_cert_error_string(error));
    }
}

/// The certificate is checked without the CRL first: both begin and end together, and a line about
/// the certificate is clearer.
std::string check_identity(X509* identity, X509* authority, X509_CRL* crl, std::time_t now)
{
    const Store store(X509_STORE_new());
    X509_STORE_add_cert(store.get(), authority);
    X509_STORE_add_crl(store.get(), crl);
    for (const unsigned long flags : {0UL, static_cast<unsigned long>(X509_V_FLAG_CRL_CHECK)})
    {
        const StoreContext context(X509_STORE_CTX_new());
        if (X509_STORE_CTX_init(context.get(), store.get(), identity, nullptr) != 1)
        {
            return "OpenSSL has no room";
        }
        X509_VERIFY_PARAM* how = X509_STORE_CTX_get0_param(context.get());
        X509_VERIFY_PARAM_set_flags(how, flags);
        X509_VERIFY_PARAM_set_time(how, now);
        if (X509_verify_cert(context.get()) != 1)
        {
            return why_not_valid(context.get(), crl, now);
        }
    }
    return "";
}

void free_stack(STACK_OF(X509) * certificates)
{
    sk_X509_free(certificates); // The certificates have other owners.
}

/// Text of a file that the authority itself signed. A signature by a certificate below the
/// authority does not count.
std::optional<std::string> verified_text(const std::string& path, X509* authority)
{
    const Bio file(BIO_new_file(path.c_str(), "r"));
    BIO* content = nullptr;
    const SignedText text(file ? SMIME_read_PKCS7(file.get(), &content) : nullptr);
    const Bio content_owner(content);
    const Bio out(BIO_new(BIO_s_mem()));
    const std::unique_ptr<STACK_OF(X509), Free<free_stack>> signers(sk_X509_new_null());
    sk_X509_push(signers.get(), authority);
    if (!text || PKCS7_verify(text.get(), signers.get(), nullptr, content, out.get(),
                              PKCS7_TEXT | PKCS7_NOINTERN | PKCS7_NOVERIFY) != 1)
    {
        return std::nullopt;
    }
    char* bytes = nullptr;
    const long size = BIO_get_mem_data(out.get(), &bytes);
    return std::string(bytes, static_cast<std::size_t>(size));
}

/// Number of the next <TAG> from `at`; `at` is then the place behind the tag.
std::optional<std::uint32_t> number_in(std::string_view text, std::string_view tag, std::size_t& at)
{
    const std::size_t found = text.find(tag, at);
    at = std::string_view::npos;
    if (found == std::string_view::npos)
    {
        return std::nullopt;
    }
    std::string_view rest = text.substr(found + tag.size());
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t\r\n"), rest.size()));
    std::uint32_t number = 0;
    if (std::from_chars(rest.data(), rest.data() + rest.size(), number).ec != std::errc())
    {
        return std::nullopt;
    }
    at = found + tag.size();
    return number;
}

/// True if a <domains> element of the document contains the domain, by <id> or <min> and <max>.
bool has_domain(std::string_view document, std::uint32_t domain)
{
    for (std::size_t at = 0; const auto id = number_in(document, "<id>", at);)
    {
        if (*id == domain)
        {
            return true;
        }
    }
    for (std::size_t at = 0; const auto least = number_in(document, "<min>", at);)
    {
        if (const auto most = number_in(document, "<max>", at);
            most && *least <= domain && domain <= *most)
        {
            return true;
        }
    }
    return false;
}

/// Checks a document that must contain `name`; for the governance that is empty.
std::string check_document(const std::string& folder, const char* file, X509* authority,
                           std::uint32_t domain, const std::string& name)
{
    const auto text = verified_text(join_path(folder, file), authority);
    if (!text)
    {
        return fmt::format("{} was changed, or {} did not sign it", file, kPermissionsCaFile);
    }
    if (!has_domain(*text, domain))
    {
        return fmt::format("{} is for another domain than {}", file, domain);
    }
    return text->find(name) != std::string::npos
               ? ""
               : fmt::format("{} gives no rights to '{}'", file, name);
}

std::string name_of(const X509* certificate)
{
    const X509_NAME* subject = X509_get_subject_name(certificate);
    const int at = X509_NAME_get_index_by_NID(subject, NID_commonName, -1);
    const ASN1_STRING* text =
        at < 0 ? nullptr : X509_NAME_ENTRY_get_data(X509_NAME_get_entry(subject, at));
    return text == nullptr ? ""
                           : printable({reinterpret_cast<const char*>(ASN1_STRING_get0_data(text)),
                                        static_cast<std::size_t>(ASN1_STRING_length(text))});
}

/// Cyclone reads the first certificate of a file; another one would be left out without a word.
std::string why_several(const std::string& folder)
{
    constexpr std::string_view kBegin = "-----BEGIN CERTIFICATE-----";
    for (const char* file : {kIdentityCaFile, kPermissionsCaFile, kIdentityFile})
    {
        const auto bytes = read_file(join_path(folder, file), kCertificatesMost);
        const std::string& text = bytes ? bytes.value() : "";
        std::size_t count = 0;
        for (std::size_t at = text.find(kBegin); at != std::string::npos;
             at = text.find(kBegin, at + kBegin.size()))
        {
            ++count;
        }
        if (!bytes || count > 1)
        {
            return bytes ? fmt::format("{} has {} certificates; Cyclone DDS reads one", file, count)
                         : fmt::format("{} can't be read", file);
        }
    }
    return "";
}

/// Returns the fault of the files or an empty text, and fills in name and validity.
std::string check_files(KeyFolder& keys, std::uint32_t domain, std::time_t now)
{
    const auto path_of = [&](const char* file) { return join_path(keys.path, file); };
    const Certificate identity = read_certificate(path_of(kIdentityFile));
    const Certificate identity_ca = read_certificate(path_of(kIdentityCaFile));
    const Certificate permissions_ca = read_certificate(path_of(kPermissionsCaFile));
    const Crl crl = read_crl(path_of(kCrlFile));
    const Key key = read_key(path_of(kKeyFile));
    const std::pair<const char*, bool> read[] = {{kIdentityFile, identity != nullptr},
                                                 {kIdentityCaFile, identity_ca != nullptr},
                                                 {kPermissionsCaFile, permissions_ca != nullptr},
                                                 {kCrlFile, crl != nullptr},
                                                 {kKeyFile, key != nullptr}};
    for (const auto& [file, is_read] : read)
    {
        if (!is_read)
        {
            return fmt::format("{} can't be read", file);
        }
    }
    if (X509_check_private_key(identity.get(), key.get()) != 1)
    {
        return fmt::format("{} is not the key of {}", kKeyFile, kIdentityFile);
    }
    keys.name = name_of(identity.get());
    if (!is_valid_name(keys.name))
    {
        return fmt::format("{} is for no valid name", kIdentityFile);
    }
    const auto end_of = [](const Certificate& certificate)
    { return time_of(X509_get0_notAfter(certificate.get())); };
    keys.valid_until = std::min({end_of(identity), end_of(identity_ca), end_of(permissions_ca),
                                 time_of(X509_CRL_get0_nextUpdate(crl.get()))});
    std::string fault = check_identity(identity.get(), identity_ca.get(), crl.get(), now);
    if (fault.empty() && end_of(permissions_ca) <= now)
    {
        fault = fmt::format("{} ended {}", kPermissionsCaFile, date_text(end_of(permissions_ca)));
    }
    const std::pair<const char*, std::string> documents[] = {{kGovernanceFile, ""},
                                                             {kPermissionsFile, keys.name}};
    for (const auto& [file, name] : documents)
    {
        fault = fault.empty() ? check_document(keys.path, file, permissions_ca.get(), domain, name)
                              : fault;
    }
    return fault;
}

} // namespace

Result<KeyFolder, Refusal> read_key_folder(const std::string& path, std::uint32_t domain,
                                           std::time_t now)
{
    if (domain > kMaxSecuredDomain)
    {
        return Refusal{fmt::format("--security: DDS domain {} can't be protected: Cyclone DDS does "
                                   "so up to {}",
                                   domain, kMaxSecuredDomain)};
    }
    std::error_code error;
    KeyFolder keys{fs::absolute(path, error).string(), {}, {}};
    std::string fault = why_incomplete(keys.path);
    if (fault.empty() && is_open_to_others(join_path(keys.path, kKeyFile)))
    {
        fault = fmt::format("other users may read {}; chmod 600 makes it a secret", kKeyFile);
    }
    fault = fault.empty() ? why_changeable(keys.path) : fault;
    fault = fault.empty() ? why_several(keys.path) : fault;
    fault = fault.empty() ? check_files(keys, domain, now) : fault;
    if (!fault.empty())
    {
        return Refusal{fmt::format("--security: {}: {}", printable(path), fault)};
    }
    return keys;
}

std::string certificate_digits(const std::string& name)
{
    constexpr std::size_t kBytes = 6; // Cyclone's plugin has 47 bits of the hash behind a one.
    const Name subject = subject_of(name);
    unsigned char* der = nullptr;
    const int size = subject ? i2d_X509_NAME(subject.get(), &der) : -1;
    if (size <= 0)
    {
        return {};
    }
    std::array<unsigned char, SHA256_DIGEST_LENGTH> hash{};
    SHA256(der, static_cast<std::size_t>(size), hash.data());
    OPENSSL_free(der);
    std::string digits;
    unsigned carried = 1;
    for (std::size_t i = 0; i < kBytes; ++i)
    {
        digits += fmt::format("{:02x}", (carried << 7U | hash[i] >> 1U) & 0xFFU);
        carried = hash[i] & 1U;
    }
    return digits;
}

} // namespace tactus::dds
