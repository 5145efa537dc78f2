// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/openssl_handles.hpp"

#include <openssl/asn1.h>
#include <openssl/pem.h>
#include <utility>

namespace tactus::openssl
{

namespace
{

/// Prevents OpenSSL's question at the terminal.
int refuse_password(char* /*buffer*/, int /*size*/, int /*writes*/, void* /*context*/)
{
    return -1;
}

template <typename Owner>
Owner read_pem(const std::string& path,
               typename Owner::pointer (*read)(BIO*, typename Owner::pointer*, pem_password_cb*,
                                               void*))
{
    const Bio file(BIO_new_file(path.c_str(), "r"));
    return Owner(file ? read(file.get(), nullptr, refuse_password, nullptr) : nullptr);
}

} // namespace

Name subject_of(const std::string& name)
{
    Name subject(X509_NAME_new());
    const int added = X509_NAME_add_entry_by_txt(
        subject.get(), "CN", MBSTRING_UTF8, reinterpret_cast<const unsigned char*>(name.data()),
        static_cast<int>(name.size()), -1, 0);
    return added == 1 ? std::move(subject) : nullptr;
}

Certificate read_certificate(const std::string& path)
{
    return read_pem<Certificate>(path, PEM_read_bio_X509);
}

Crl read_crl(const std::string& path)
{
    return read_pem<Crl>(path, PEM_read_bio_X509_CRL);
}

Key read_key(const std::string& path)
{
    return read_pem<Key>(path, PEM_read_bio_PrivateKey);
}

} // namespace tactus::openssl
