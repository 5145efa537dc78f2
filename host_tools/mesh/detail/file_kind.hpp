// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/read_mesh.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace tactus::detail
{

/// Message about a refused file, judged by its first bytes: the format that it has instead of the
/// expected one, if any, and a remedy; empty if unknown. The readers do not use it to select a
/// format.
[[nodiscard]] std::string other_kind(std::string_view bytes, std::optional<MeshFormat> expected);

} // namespace tactus::detail
