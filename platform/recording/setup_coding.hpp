// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/fixed_writer.hpp"
#include "platform/recording/recording_format.hpp"
#include "rt_core/base/byte_io.hpp"
#include "rt_core/records/device_record.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/scene_change.hpp"
#include "rt_core/spm/header.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus
{

/// Content of the setup section: everything except the models, of which it holds the number.
[[nodiscard]] std::vector<std::byte> code_setup(const RecordedSetup& setup);
/// Content of one model section.
[[nodiscard]] std::vector<std::byte> code_model(const RecordedModel& model);

/// Content of a name section; a name that is too long is cut.
[[nodiscard]] std::vector<std::byte> code_name(const RecordedName& what, std::string_view name);

/// Reads a setup section and the number of models that follow. Returns the fault, if any.
[[nodiscard]] std::optional<std::string> parse_setup(std::span<const std::byte> payload,
                                                     RecordedSetup& setup, std::uint32_t& models);
/// Reads a model section and its counts. `bytes_left`: bytes that the pools may still take; reduced
/// by this model's. Returns the fault, if any.
[[nodiscard]] std::optional<std::string> parse_model(std::span<const std::byte> payload,
                                                     bool has_streamed_models, RecordedModel& model,
                                                     ModelCounts& counts, std::size_t& bytes_left);

/// Reads a name section into the names of the setup, whose models were read. Returns the fault, if
/// any.
[[nodiscard]] std::optional<std::string> parse_name(std::span<const std::byte> payload,
                                                    RecordedSetup& setup);

/// Fault if a section's content ends before or after its payload.
[[nodiscard]] std::optional<std::string> unless_whole(const ByteReader& reader,
                                                      const char* section);

/// Largest coded sizes in bytes: of a pose, of an object's specification, and of a whole change.
inline constexpr std::size_t kObjectPoseBytes = 124;
inline constexpr std::size_t kObjectSpecBytes = 60;
inline constexpr std::size_t kSceneChangeBytes = 9 + kObjectSpecBytes + kObjectPoseBytes;

/// Writes a change. Allocates nothing. docs/recording.md lists the fields.
void write_change(FixedWriter& writer, const SceneChange& change) noexcept;

/// Reads a change. False if the kind is unknown; the reader reports missing bytes.
[[nodiscard]] bool try_read(ByteReader& reader, SceneChange& change);

[[nodiscard]] Vec3 read_vector(ByteReader& reader);
/// Reads a rotation, row by row.
[[nodiscard]] Mat3 read_rotation(ByteReader& reader);

/// Largest coded size of a tool's state and its device's record, in bytes.
inline constexpr std::size_t kToolStateBytes = 38 + 72 + 96 + 24 + 24 + 4 + 8 + 24 + 24 + 8;

/// Writes a tool's state and its device's record, in the format of docs/recording.md.
void write_tool(FixedWriter& writer, const ToolState& tool, const DeviceRecord& device) noexcept;

/// Reads a tool. Absent values become none, zero or the identity. False if the flags don't match
/// the values; the reader reports missing bytes.
[[nodiscard]] bool try_read_tool(ByteReader& reader, ToolState& tool, DeviceRecord& device);

} // namespace tactus
