// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/base/printable.hpp"
#include "platform/base/refusal.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/content_hash.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Any thread, but not the haptic one: calls allocate, and work on their arguments alone.
namespace tactus
{

/// Whether a model's or tool's name may appear on the wire and on a terminal, and is a "valid" one
/// wherever these headers ask for that: 1 to kMaxNameBytes bytes of
/// [A-Za-z0-9._-], so no control characters, no separators, no surprises in a log.
[[nodiscard]] constexpr bool is_valid_name(std::string_view name) noexcept
{
    return !name.empty() && name.size() <= kMaxNameBytes &&
           std::all_of(name.begin(), name.end(),
                       [](char c)
                       {
                           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                                  (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-';
                       });
}

/// Whether a server may be called so: by its machine and perhaps its process, MACHINE or
/// MACHINE:PROCESS, or with DDS Security by its certificate, cert: and 12 digits of 0-9 a-f. A
/// machine's name has 1 to 64 characters of A-Z a-z 0-9 . _ -
[[nodiscard]] constexpr bool is_valid_server(std::string_view server) noexcept
{
    constexpr std::size_t kMachineBytes = 64; // HOST_NAME_MAX of Linux.
    constexpr std::size_t kProcessDigits = 10;
    constexpr std::size_t kCertificateDigits = 12;
    const auto is_of = [](std::string_view text, std::string_view characters)
    { return !text.empty() && text.find_first_not_of(characters) == std::string_view::npos; };
    const std::size_t colon = server.find(':');
    const std::string_view first = server.substr(0, colon);
    if (colon == std::string_view::npos || first != "cert")
    {
        const std::string_view process =
            colon == std::string_view::npos ? "0" : server.substr(colon + 1);
        return !first.empty() && first.size() <= kMachineBytes &&
               std::all_of(first.begin(), first.end(),
                           [](char c) {
                               return is_valid_name({&c, 1});
                           }) &&
               process.size() <= kProcessDigits && is_of(process, "0123456789");
    }
    const std::string_view certificate = server.substr(colon + 1);
    return certificate.size() == kCertificateDigits && is_of(certificate, "0123456789abcdef");
}

/// Which model or scene is meant: by name, or by name and hash or server. Without those the first
/// server that answers says it.
struct ModelSelector
{
    std::string name; ///< Empty: any.
    std::optional<ContentHash> hash{};
    std::string server{}; ///< Empty: any.
};

/// Reads NAME, NAME@HASH or NAME@SERVER, HASH being 32 hexadecimal digits. Other texts are refused
/// in one line.
[[nodiscard]] inline Result<ModelSelector, Refusal> parse_selector(std::string_view text)
{
    const std::size_t at = text.find('@');
    ModelSelector selector;
    selector.name = text.substr(0, at);
    if (!is_valid_name(selector.name))
    {
        return Refusal{"name '" + printable(selector.name) +
                       "' is not 1 to 63 characters of A-Z a-z 0-9 . _ -"};
    }
    if (at != std::string_view::npos)
    {
        const std::string_view pin = text.substr(at + 1);
        selector.hash = parse_hash(pin);
        if (!selector.hash && !is_valid_server(pin))
        {
            return Refusal{"'" + printable(pin) +
                           "' behind @ is neither a hash of 32 hexadecimal digits nor a server, "
                           "MACHINE[:PROCESS] or cert: and 12 digits of 0-9 a-f"};
        }
        selector.server = selector.hash ? "" : pin;
    }
    return selector;
}

/// Which servers may take the place of one that is gone.
struct Failover
{
    bool any{false};
    std::vector<std::string> servers{}; ///< As in NAME@SERVER.
};

} // namespace tactus
