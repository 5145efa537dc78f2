// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/simplify.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus
{

/// The regular partition of a model's box into cubic regions.
struct RegionGrid
{
    std::uint32_t cell_quanta{0}; ///< Edge of a region; a power of two.
    std::array<std::uint32_t, 3> cells{};
    /// One bit a region, set if it may have surface; the x index runs fastest.
    std::vector<std::byte> occupied;
    std::uint32_t occupied_count{0};

    [[nodiscard]] std::uint64_t count() const noexcept
    {
        return std::uint64_t{cells[0]} * cells[1] * cells[2];
    }
};

/// The least power of two that cuts the longest axis into at most 16 cells.
[[nodiscard]] std::uint32_t default_cell(const std::array<std::uint32_t, 3>& extent_quanta);

/// Makes a grid without occupied cells; `occupied` stays empty. Allocates nothing, so that count()
/// can be checked first.
[[nodiscard]] RegionGrid make_region_grid(const std::array<std::uint32_t, 3>& extent_quanta,
                                          std::uint32_t cell_quanta);

/// Marks every region that the box of a face touches: all with surface and, beside large slanted
/// faces, some without. Linear in faces and regions, for faces of any size.
void mark_occupied(RegionGrid& grid, const QuantisedMesh& mesh);

} // namespace tactus
