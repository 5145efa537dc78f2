// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/placed_blocks.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/math/rounding.hpp"

#include <bit>
#include <cstddef>

namespace tactus
{

PlacedBlocks::PlacedBlocks(const AbTree& tool, const AbTree& object, const MeshPlacement& place,
                           const MeshViews& views) noexcept
    : tool_(tool), object_(object), place_(place), views_(views)
{
}

const PlacedBlock& PlacedBlocks::get(std::uint32_t index) noexcept
{
    TACTUS_ASSERT(tool_.is_block_in_use(index));
    PlacedBlock& placed = blocks_[index % kKept];
    if (placed.index != index)
    {
        put(index, placed);
    }
    return placed;
}

void PlacedBlocks::put(std::uint32_t index, PlacedBlock& placed) const noexcept
{
    const BlockGeometry& block = tool_.block(index);
    const BlockSide& side = tool_.side(index);
    const auto quantum_m = static_cast<double>(object_.quantum_m());
    placed.index = index;
    placed.box = views_.of_tool().of(
        AabbVolume::of_vertices(tool_.kernels(), block.coordinates.front().data(), block.vertices));
    placed.largest_error_m = static_cast<double>(largest_error_quanta(side)) *
                             static_cast<double>(tool_.quantum_m()) * views_.scale() * kRoundedUp;
    const KernelProbe& center = placed.box.center;
    alignas(64) std::array<std::array<float, kBlockVertices>, 3> around{};
    for (std::uint32_t rows = block.vertices; rows != 0; rows &= rows - 1)
    {
        const auto row = static_cast<std::size_t>(std::countr_zero(rows));
        const Vec3 vertex_m = place_.to_there(to_vec3(Vec3f{
            block.coordinates[0][row], block.coordinates[1][row], block.coordinates[2][row]}));
        placed.vertices_m[row] = vertex_m;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const double from =
                static_cast<double>(center.high[axis]) + static_cast<double>(center.low[axis]);
            around[axis][row] =
                static_cast<float>((vertex_m[static_cast<Eigen::Index>(axis)] - from) / quantum_m);
        }
    }
    const KernelProbe here{{0.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 0.0F}, 1.0F, 0.0F};
    tool_.kernels().place_triangles(around.front().data(), block.corners.front().data(), here,
                                    placed.rows);
}

} // namespace tactus
