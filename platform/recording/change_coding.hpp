// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/fixed_writer.hpp"
#include "rt_core/base/byte_io.hpp"
#include "rt_core/records/scene_change.hpp"

namespace tactus
{

/// Bytes of a change at most.
inline constexpr std::size_t kObjectPoseBytes = 124;
inline constexpr std::size_t kObjectSpecBytes = 60;
inline constexpr std::size_t kSceneChangeBytes = 9 + kObjectSpecBytes + kObjectPoseBytes;

/// Allocates nothing. docs/recording.md lists the fields.
void write_change(FixedWriter& writer, const SceneChange& change) noexcept;

/// False when the kind is unknown; whether the bytes sufficed the reader says.
[[nodiscard]] bool try_read(ByteReader& reader, SceneChange& change);

[[nodiscard]] Vec3 read_vector(ByteReader& reader);
/// Row by row.
[[nodiscard]] Mat3 read_rotation(ByteReader& reader);

} // namespace tactus
