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

// Any thread except the haptic one: calls allocate. Results depend on the arguments alone.
namespace tactus
{

/// Text that describes a valid name, for messages.
inline constexpr std::string_view kNameForm = "1 to 63 bytes of letters, digits, . _ -";

/// True if a UTF-8 character may be in a name: A-Z a-z 0-9 . _ - and the letters of every language,
/// but no control characters and no separators.
[[nodiscard]] bool is_name_character(std::string_view character) noexcept;

/// True if the name of a model or tool may appear on the wire and on a terminal: 1 to kMaxNameBytes
/// bytes of characters that pass is_name_character(). Other headers call such a name "valid". Names
/// are compared byte by byte.
[[nodiscard]] bool is_valid_name(std::string_view name) noexcept;

/// True for the identity of a server: MACHINE, MACHINE:PROCESS, or with DDS Security cert: and 12
/// digits of 0-9 a-f. MACHINE has 1 to 64 characters of A-Z a-z 0-9 . _ -
[[nodiscard]] bool is_valid_server(std::string_view server) noexcept;

/// Selects a model or scene by its name, and optionally by its hash or server. Without either, the
/// first server that answers is taken.
struct ModelSelector
{
    std::string name; ///< Name; empty: any.
    std::optional<ContentHash> hash{};
    std::string server{}; ///< Server; empty: any.
};

/// Reads NAME, NAME@HASH or NAME@SERVER, where HASH is 32 hexadecimal digits. The refusal is one
/// line.
[[nodiscard]] Result<ModelSelector, Refusal> parse_selector(std::string_view text);

/// Servers that may replace a server that is gone.
struct Failover
{
    bool any{false};
    /// Servers as is_valid_server() accepts them; ignored if `any`.
    std::vector<std::string> servers{};
};

} // namespace tactus
