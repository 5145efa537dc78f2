// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/byte_io.hpp"
#include "rt_core/geometry/tool_core.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace tactus
{

/// Vertices of a recording's hulls; copies share them.
using HullVertices = std::vector<std::shared_ptr<const std::vector<Vec3>>>;

/// Appends a tool's core: a byte for its kind, and its numbers (docs/recording.md). A core given
/// only by a support function can't be coded, since the function is code (asserted).
void append_core(std::vector<std::byte>& bytes, const ToolCore& core);

/// Reads a core. None if the kind is unknown, a length is not within -1e6 to 1e6 m, or a hull has
/// not 1 to kMaxHullVertices vertices. A hull's vertices are added to `vertices`.
[[nodiscard]] std::optional<ToolCore> read_core(ByteReader& reader, HullVertices& vertices);

} // namespace tactus
