// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/byte_io.hpp"
#include "rt_core/geometry/tool_core.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace tactus
{

/// A tool's core in a recording: a byte for its kind and its numbers (docs/recording.md).
void append_core(std::vector<std::byte>& bytes, const ToolCore& core);

/// None when the kind is unknown or a length is not within -1e6 to 1e6 m.
[[nodiscard]] std::optional<ToolCore> read_core(ByteReader& reader);

} // namespace tactus
