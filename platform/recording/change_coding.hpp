// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/fixed_writer.hpp"
#include "rt_core/base/byte_io.hpp"
#include "rt_core/records/scene_change.hpp"

namespace tactus
{

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

} // namespace tactus
