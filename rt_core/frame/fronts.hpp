// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/frame/model.hpp"
#include "rt_core/spm/ids.hpp"

#include <cstdint>
#include <span>

namespace tactus
{

/// Counts of the two fronts of the 3DIM 2005 paper, for reports and tests. Each record belongs to
/// one region: the cell of the model's regular partition that holds its vertex.
///
/// The functions below visit each record of each adopted page: about 10 ns a record, 1 ms for 1,600
/// pages. Not for use within a frame. Haptic thread, or any thread while no frame runs.
struct FrontCount
{
    std::uint32_t loaded{0};  ///< Linked records of adopted pages.
    std::uint32_t refined{0}; ///< Records that are split; all of them are loaded.
};

/// Counts both fronts in the whole model, or in one region.
[[nodiscard]] FrontCount count_fronts(const Model& model) noexcept;
[[nodiscard]] FrontCount count_fronts(const Model& model, RegionId region) noexcept;

/// Writes the split records of the region into `out`, as many as fit, in the order of page slots.
/// Returns their total; if it is above `out.size()`, the list is truncated.
std::uint32_t list_refined_front(const Model& model, RegionId region,
                                 std::span<RecordId> out) noexcept;

/// list_refined_front() for the loaded records.
std::uint32_t list_loaded_front(const Model& model, RegionId region,
                                std::span<RecordId> out) noexcept;

} // namespace tactus
