// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <string>

namespace tactus
{

/// The options --security, --plain and --require-security of all programs that use DDS.
struct NetworkSecurity
{
    std::string keys;        ///< Folder of keys that tactus-keys made; empty: none.
    bool is_plain{false};    ///< True if a network may be joined without keys.
    bool is_required{false}; ///< True if no domain may be joined without keys, loopback included.
};

} // namespace tactus
