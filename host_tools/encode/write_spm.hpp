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

// Any thread, but not the haptic one: it allocates, waits for the file and starts threads.
namespace tactus
{

/// A base mesh of more faces than were asked for may have this many, where pieces, holes or handles
/// keep it from shrinking: with its part of forest and tree it takes less than a quarter of hrtc's
/// default pools of 2 MiB.
inline constexpr std::uint32_t kGrownBaseFaces = 2'000;

struct EncodeOptions
{
    /// As the mesh was prepared with: that its coordinates fit is asserted.
    std::uint32_t position_bits{kMinPositionBits};
    /// A larger base is refused, unless it has at most kGrownBaseFaces; one of more than
    /// kMaxBaseFaces is refused always.
    std::uint32_t base_faces{500};
    /// Edge of a region, rounded down to a power of two quanta, one at least; more than kMaxRegions
    /// are refused. Without it the longest axis gets at most 16 regions.
    std::optional<double> region_size_m;
    unsigned threads{1}; ///< 1 or more; the file does not depend on it.
    /// Called on the calling thread as chunks are written: how many, and how many there are.
    std::function<void(std::size_t done, std::size_t total)> progress{};
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
