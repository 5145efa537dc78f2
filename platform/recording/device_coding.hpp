// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/fixed_writer.hpp"
#include "rt_core/base/byte_io.hpp"
#include "rt_core/records/device_record.hpp"
#include "rt_core/records/frame_input.hpp"

#include <cstddef>

namespace tactus
{

/// Of a tool and its device in a coded frame, with all that there can be.
inline constexpr std::size_t kToolStateBytes = 38 + 72 + 96 + 24 + 24 + 4 + 8 + 24 + 24 + 8;

/// A tool's state and what its device said and was told, as docs/recording.md lists them.
void write_tool(FixedWriter& writer, const ToolState& tool, const DeviceRecord& device) noexcept;

/// False when its flags are not those of what it says: what isn't there isn't written. Too few
/// bytes show at the reader.
[[nodiscard]] bool try_read_tool(ByteReader& reader, ToolState& tool, DeviceRecord& device);

} // namespace tactus
