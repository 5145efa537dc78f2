// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/header.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus::fuzz
{

/// A small model's pieces as they are coded by this build, so that what is fuzzed always knows the
/// coder's present version.
struct CodedModel
{
    std::vector<std::byte> header_bytes;
    ModelHeader header; ///< Looks into header_bytes.
    std::vector<std::byte> base;
    std::vector<std::vector<std::byte>> chunks;
};

/// Which generated shape. More faces mean more chunks: one for each 128.
enum class Lump : std::uint32_t
{
    closed, ///< A bumpy sphere of 720 faces.
    open,   ///< A terrain of about 800, with a border.
};

/// Made by the encoder, once a process. Ends the program when a step refuses.
[[nodiscard]] const CodedModel& coded_model(Lump lump);

} // namespace tactus::fuzz
