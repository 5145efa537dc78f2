// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/prepare.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/base/refusal.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

// Any thread, except the haptic one: it allocates, waits for the file and starts threads.
namespace tactus
{

/// Maximum number of faces of a base mesh that pieces, holes or handles keep above the requested
/// number: with its part of forest and tree it takes less than a quarter of hrtc's default pools of
/// 2 MiB.
inline constexpr std::uint32_t kGrownBaseFaces = 2'000;

/// Options of the file that is written.
struct EncodeOptions
{
    /// Bits of the prepared mesh; its coordinates must fit (asserted).
    std::uint32_t position_bits{kMinPositionBits};
    /// Maximum number of faces of the base mesh. A larger base is refused, unless it has at most
    /// kGrownBaseFaces; one above kMaxBaseFaces is always refused.
    std::uint32_t base_faces{500};
    /// Edge of a region, rounded down to a power of two quanta, at least one; refused above
    /// kMaxRegions. [default: at most 16 regions along the longest axis]
    std::optional<double> region_size_m;
    std::uint32_t revision{0}; ///< HeaderFields::revision.
    unsigned threads{1};       ///< Number of threads, at least 1; the file does not depend on it.
    /// Callback on the calling thread as chunks are written, with their number so far and in total.
    std::function<void(std::size_t done, std::size_t total)> progress{};
};

/// Writes a model's file: header, base mesh, index pages, chunks. The file appears under its name
/// only when complete; a refusal, one line with the path, leaves nothing new on the disk.
/// `simplification` is that of the prepared mesh. Returns the header's fields. Deterministic.
/// Linear memory, about 100 B a face beside the arguments; chunks are coded in parallel and written
/// in batches.
[[nodiscard]] Result<HeaderFields, Refusal> write_spm(const std::filesystem::path& path,
                                                      const PreparedMesh& prepared,
                                                      const Simplification& simplification,
                                                      const EncodeOptions& options);

} // namespace tactus
