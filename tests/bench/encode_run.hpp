// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/limits.hpp"
#include "tests/bench/encoder_cases.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

namespace tactus::bench
{

struct EncodeJob
{
    std::filesystem::path path;
    std::uint32_t position_bits{kMinPositionBits};
    unsigned threads{1};     ///< One is held to one core.
    std::uint32_t passes{1}; ///< At least one.
};

/// How the encoder's run went that took least time, and the highest peak of all.
struct EncodeRun
{
    std::string scene;
    double prepare_s{0.0}; ///< From a mesh in memory.
    double simplify_s{0.0};
    double write_s{0.0};     ///< Until the file is there.
    double processor_s{0.0}; ///< Of all threads; less than the others' sum when it had to wait.
    std::uint64_t peak_bytes{0};

    [[nodiscard]] double total_s() const { return prepare_s + simplify_s + write_s; }
};

/// Encodes the context's mesh as spm_build does, each pass in a process of its own. A base mesh
/// larger than the usual one is written all the same, so that there is a figure of it.
[[nodiscard]] Result<EncodeRun, SceneError> encode_in_child(const EncoderContext& context,
                                                            const EncodeJob& job);

} // namespace tactus::bench
