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

/// Largest coded size of a tool's state and its device's record, in bytes.
inline constexpr std::size_t kToolStateBytes = 38 + 72 + 96 + 24 + 24 + 4 + 8 + 24 + 24 + 8;

/// Writes a tool's state and its device's record, in the format of docs/recording.md.
void write_tool(FixedWriter& writer, const ToolState& tool, const DeviceRecord& device) noexcept;

/// Reads a tool. Absent values become none, zero or the identity. False if the flags don't match
/// the values; the reader reports missing bytes.
[[nodiscard]] bool try_read_tool(ByteReader& reader, ToolState& tool, DeviceRecord& device);

} // namespace tactus
