// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/read_mesh.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace tactus::detail
{

/// What a file is by its first bytes, and the way out, when it is none of the format that is
/// expected, if any; empty when they tell nothing. For a file that was refused: a reader alone
/// decides what it reads.
[[nodiscard]] std::string other_kind(std::string_view bytes, std::optional<MeshFormat> expected);

} // namespace tactus::detail
