// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/header.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus::fuzz
{

/// Pieces of a small model as this build codes them, so that fuzzing always uses the present
/// version.
struct CodedModel
{
    std::vector<std::byte> header_bytes;
    ModelHeader header; ///< View of header_bytes.
    std::vector<std::byte> base;
    std::vector<std::vector<std::byte>> chunks;
};

/// Generated shapes. More faces mean more chunks: one for each 128.
enum class Lump : std::uint32_t
{
    closed, ///< Bumpy sphere of 720 faces.
    open,   ///< Terrain of about 800 faces, with a border.
};

/// Model made by the encoder, once a process. Ends the program if a step refuses.
[[nodiscard]] const CodedModel& coded_model(Lump lump);

} // namespace tactus::fuzz
