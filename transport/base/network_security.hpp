// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <string>

namespace tactus
{

/// The options --security and --plain of all programs that use DDS.
struct NetworkSecurity
{
    std::string keys;     ///< Folder that tactus-keys made; empty: none.
    bool is_plain{false}; ///< A network beyond this machine may be joined without keys.
};

} // namespace tactus
