// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/prepare.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "platform/base/refusal.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/spm/header.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

// Any thread, but not the haptic one: it allocates, waits for the file and starts threads.
namespace tactus
{

struct EncodeOptions
{
    /// As the mesh was prepared with: that its coordinates fit is asserted.
    std::uint32_t position_bits{kMinPositionBits};
    /// A larger base is refused, unless it has at most 500 faces; one of more than kMaxBaseFaces is
    /// refused always.
    std::uint32_t base_faces{500};
    /// Edge of a region, rounded down to a power of two quanta, one at least; more than kMaxRegions
    /// are refused. Without it the longest axis gets at most 16 regions.
    std::optional<double> region_size_m;
    unsigned threads{1}; ///< 1 or more; the file does not depend on it.
};

/// Writes a model's file: header, base mesh, index pages, chunks. The file appears under its name
/// only when it is whole; after a refusal, one line with the path, there is nothing new on the
/// disk. `simplification` is that of the prepared mesh. Returns the header's fields. The same
/// arguments give the same bytes. Linear memory, about 100 B a face beside the arguments; chunks
/// are coded side by side and go to the disk batch by batch.
[[nodiscard]] Result<HeaderFields, Refusal> write_spm(const std::filesystem::path& path,
                                                      const PreparedMesh& prepared,
                                                      const Simplification& simplification,
                                                      const EncodeOptions& options);

} // namespace tactus
