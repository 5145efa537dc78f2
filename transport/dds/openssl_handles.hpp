// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <memory>
#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/pkcs7.h>
#include <openssl/x509.h>
#include <string>

// Owners of OpenSSL's objects. A null pointer stands for an object that could not be made or read.
namespace tactus::openssl
{

template <auto kFree>
struct Free
{
    template <typename T>
    void operator()(T* object) const noexcept
    {
        kFree(object);
    }
};

using Bio = std::unique_ptr<BIO, Free<BIO_free_all>>;
using Certificate = std::unique_ptr<X509, Free<X509_free>>;
using Crl = std::unique_ptr<X509_CRL, Free<X509_CRL_free>>;
using Key = std::unique_ptr<EVP_PKEY, Free<EVP_PKEY_free>>;
using Name = std::unique_ptr<X509_NAME, Free<X509_NAME_free>>;
using SignedText = std::unique_ptr<PKCS7, Free<PKCS7_free>>;
using Store = std::unique_ptr<X509_STORE, Free<X509_STORE_free>>;
using StoreContext = std::unique_ptr<X509_STORE_CTX, Free<X509_STORE_CTX_free>>;

/// Subject of a program's certificate: CN=`name` and nothing else. Null if the name is too long.
[[nodiscard]] Name subject_of(const std::string& name);

/// Read a file in PEM. Null if the file is missing, has other contents, or has a key with a
/// password.
[[nodiscard]] Certificate read_certificate(const std::string& path);
[[nodiscard]] Crl read_crl(const std::string& path);
[[nodiscard]] Key read_key(const std::string& path);

} // namespace tactus::openssl
