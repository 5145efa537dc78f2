// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/base/refusal.hpp"
#include "transport/content_hash.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Any thread, but not the haptic one: calls allocate, and work on their arguments alone.
namespace tactus
{

/// What a valid name is; for messages.
inline constexpr std::string_view kNameForm = "1 to 63 bytes of letters, digits, . _ -";

/// Whether a character, of UTF-8, may be in a name: A-Z a-z 0-9 . _ - and the letters of every
/// language, so no control characters, no separators, no surprises in a log.
[[nodiscard]] bool is_name_character(std::string_view character) noexcept;

/// Whether a model's or tool's name may appear on the wire and on a terminal, and is a "valid" one
/// wherever these headers ask for that: 1 to kMaxNameBytes bytes of such characters. Names are
/// equal when their bytes are.
[[nodiscard]] bool is_valid_name(std::string_view name) noexcept;

/// Whether a server may be called so: by its machine and perhaps its process, MACHINE or
/// MACHINE:PROCESS, or with DDS Security by its certificate, cert: and 12 digits of 0-9 a-f. A
/// machine's name has 1 to 64 characters of A-Z a-z 0-9 . _ -
[[nodiscard]] bool is_valid_server(std::string_view server) noexcept;

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
[[nodiscard]] Result<ModelSelector, Refusal> parse_selector(std::string_view text);

/// Which servers may take the place of one that is gone.
struct Failover
{
    bool any{false};
    std::vector<std::string> servers{}; ///< As in NAME@SERVER.
};

} // namespace tactus
