// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/placed_blocks.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/math/rounding.hpp"
#include "rt_core/query/pair_walk.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

namespace tactus
{

namespace
{

/// Bound on the rounding of a vertex rotated in single precision, as a share of its distance from
/// the centre.
constexpr float kTurnRounding = 0x1p-21F;

} // namespace

float PlacedBlock::largest_error(std::uint32_t lanes) const noexcept
{
    float largest = 0.0F;
    for (std::uint32_t left = coarse & lanes; left != 0; left &= left - 1)
    {
        largest = std::max(largest, rows.error[std::countr_zero(left)]);
    }
    return largest;
}

PlacedBlocks::PlacedBlocks(const AbTree& tool, const AbTree& object, const MeshPlacement& place,
                           const MeshViews& views, ErrorCode tolerance) noexcept
    : tool_(tool), object_(object), place_(place), views_(views), tolerance_(tolerance)
{
}

const PlacedBlock& PlacedBlocks::get(std::uint32_t index) noexcept
{
    TACTUS_ASSERT(tool_.is_block_in_use(index));
    last_ = index % kKept;
    PlacedBlock& placed = blocks_[last_];
    if (placed.index != index)
    {
        put(index, placed);
    }
    return placed;
}

float PlacedBlocks::lowest_along(const Vec3f& way, std::uint32_t number) noexcept
{
    TACTUS_ASSERT(number != 0);
    PlacedBlock& placed = blocks_[last_];
    if (placed.way != number)
    {
        placed.lowest = lowest_along(way);
        placed.way = number;
    }
    return placed.lowest;
}

float PlacedBlocks::lowest_along(const Vec3f& way) const noexcept
{
    const PlacedBlock& placed = blocks_[last_];
    const KernelProbe here{{0.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 0.0F}, 1.0F, 0.0F};
    const Vec3f back{-way[0], -way[1], -way[2]};
    return -tool_.kernels().highest_along(&placed.rows.vertex[0][0], placed.vertices, here,
                                          back.data()) -
           placed.slack();
}

void PlacedBlocks::put(std::uint32_t index, PlacedBlock& placed) const noexcept
{
    put(tool_.block(index), placed);
    placed.index = index;
    const BlockSide& side = tool_.side(index);
    placed.coarse = side.coarse;
    placed.open = lanes_above(side, tolerance_);
    const double quanta =
        static_cast<double>(tool_.quantum_m()) * views_.scale() / object_quantum_m();
    for (std::uint32_t lanes = side.coarse; lanes != 0; lanes &= lanes - 1)
    {
        const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
        const auto error = static_cast<double>(error_in_quanta(side.errors[lane]));
        placed.rows.error[lane] = round_up_to_float(error * quanta * kRoundedUp);
    }
}

void PlacedBlocks::put_loose(const BlockGeometry& faces, std::uint32_t coarse,
                             const std::array<double, kBlockFaces>& errors_m) noexcept
{
    last_ = 0;
    PlacedBlock& placed = blocks_[last_];
    put(faces, placed);
    placed.index = kNoNode;
    placed.coarse = coarse;
    placed.open = coarse;
    const double quanta_per_m = views_.scale() / object_quantum_m();
    for (std::uint32_t lanes = coarse; lanes != 0; lanes &= lanes - 1)
    {
        const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
        placed.rows.error[lane] = round_up_to_float(errors_m[lane] * quanta_per_m * kRoundedUp);
    }
}

/// Places a block; sets all but the index and the faces' errors.
void PlacedBlocks::put(const BlockGeometry& block, PlacedBlock& placed) const noexcept
{
    const Aabb own =
        AabbVolume::of_vertices(tool_.kernels(), block.coordinates.front().data(), block.vertices);
    placed.box = views_.of_tool().of(own);
    placed.way = 0;
    std::ranges::fill(placed.rows.error, 0.0F);
    placed.vertices = block.vertices;
    placed.faces = block.faces;
    // Vertices are rotated round the centre in single precision; `off` bounds the rounding.
    const double units_per_m = place_.place.scale / object_quantum_m();
    const Vec3 middle = 0.5 * (to_vec3(own.low) + to_vec3(own.high));
    std::array<float, 3> from{};
    std::array<float, 9> turn{};
    float size = 0.0F;
    double moved_m = 0.0;
    for (std::size_t row = 0; row < 3; ++row)
    {
        const auto axis = static_cast<Eigen::Index>(row);
        from[row] = static_cast<float>(middle[axis]);
        moved_m += std::abs(middle[axis] - static_cast<double>(from[row]));
        size += placed.box.half_along[row];
        for (std::size_t along = 0; along < 3; ++along)
        {
            turn[3 * row + along] = static_cast<float>(
                units_per_m * place_.place.rotation(axis, static_cast<Eigen::Index>(along)));
        }
    }
    tool_.kernels().place_turned(block.coordinates.front().data(), block.corners.front().data(),
                                 from.data(), turn.data(), placed.rows);
    placed.off =
        size * kTurnRounding + round_up_to_float(2.0 * moved_m * units_per_m) + views_.slack();
}

} // namespace tactus
