// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/frame/model.hpp"
#include "rt_core/spm/ids.hpp"

#include <cstdint>
#include <span>

namespace tactus
{

/// The two fronts of the 3DIM 2005 paper, region by region, for reports and tests. A record belongs
/// to the region of the header's regular partition that holds its vertex, so each record has
/// exactly one.
///
/// Every function visits each record of each adopted page once: about 10 ns a record, 1 ms for
/// 1,600 pages. Not for use within a frame. Haptic thread, or any thread while no frame runs.
struct FrontCount
{
    std::uint32_t loaded{0};  ///< Linked records of adopted pages.
    std::uint32_t refined{0}; ///< Records that are split; all of them are loaded.
};

/// Counts of both fronts over the whole model.
[[nodiscard]] FrontCount count_fronts(const Model& model) noexcept;
[[nodiscard]] FrontCount count_fronts(const Model& model, RegionId region) noexcept;

/// Writes the region's split records into `out`, as many as fit, in the order of page slots.
/// Returns their total; more than `out.size()` means that the list is truncated.
std::uint32_t list_refined_front(const Model& model, RegionId region,
                                 std::span<RecordId> out) noexcept;

/// The same for loaded records.
std::uint32_t list_loaded_front(const Model& model, RegionId region,
                                std::span<RecordId> out) noexcept;

} // namespace tactus
