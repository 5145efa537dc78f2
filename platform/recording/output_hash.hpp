// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_output.hpp"

#include <cstdint>

namespace tactus
{

/// 64-bit hashes of the parts of a FrameOutput, over all bits of every field, without padding.
/// Frames with equal hashes have given the same values.
struct OutputHashes
{
    std::uint64_t tools{0};
    std::uint64_t pairs{0};
    std::uint64_t models{0}; ///< Hash of pools, refined records and state hash of each model.
    std::uint64_t work{0};   ///< Hash of work counters, scene and faults.

    bool operator==(const OutputHashes&) const noexcept = default;
};

/// Hashes the output. About 60 multiplications for one tool and one object. `output.queues` is an
/// input and left out.
[[nodiscard]] OutputHashes hash_output(const FrameOutput& output) noexcept;

} // namespace tactus
