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

/// Which model is meant: by name, or by name and hash. Without a hash the first one seen is taken.
struct ModelSelector
{
    std::string name;
    std::optional<ContentHash> hash;
};

/// Reads NAME or NAME@HASH, HASH being 32 hexadecimal digits. Other texts are refused in one line.
[[nodiscard]] inline Result<ModelSelector, Refusal> parse_selector(std::string_view text)
{
    const std::size_t at = text.find('@');
    ModelSelector selector{std::string(text.substr(0, at)), std::nullopt};
    if (!is_valid_name(selector.name))
    {
        return Refusal{"name '" + printable(selector.name) +
                       "' is not 1 to 63 characters of A-Z a-z 0-9 . _ -"};
    }
    if (at != std::string_view::npos)
    {
        selector.hash = parse_hash(text.substr(at + 1));
        if (!selector.hash)
        {
            return Refusal{"hash '" + printable(text.substr(at + 1)) +
                           "' is not 32 hexadecimal digits"};
        }
    }
    return selector;
}

} // namespace tactus
