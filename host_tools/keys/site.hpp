// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/keys/rights.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstdint>
#include <ctime>
#include <string>
#include <vector>

namespace tactus::keys
{

/// Beside a member's keys: a drop-in for its service.
inline constexpr const char* kCredentialsFile = "credentials.conf";

struct Member
{
    Role role{Role::server};
    std::string name;
};

/// The programs of a site, and what is to be made for them.
struct Site
{
    std::uint32_t domain{0};
    std::vector<Member> members;
    std::uint32_t days{365}; ///< That certificates, rights and the CRL hold.
    std::string authority{"authority"};
    std::string output{"machines"};
    std::vector<std::string> renewed; ///< Get a new certificate,
    std::vector<std::string> revoked; ///< and these besides: the one before counts no more.
};

/// What a member has now.
struct IssuedKeys
{
    Member member;
    std::string archive;
    std::time_t until{};
    bool is_new{false};
};

/// Makes what is missing, ended or to be renewed, signs rights and CRL for `days` from `now`, and
/// writes for each member a folder output/NAME and an archive output/NAME.tar with it as keys/.
/// What is there and holds stays. A file that can't be read or written is refused.
[[nodiscard]] Result<std::vector<IssuedKeys>, Refusal> make_keys(const Site& site, std::time_t now);

} // namespace tactus::keys
