// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/abtree/block.hpp"

namespace tactus
{

namespace
{

constexpr std::uint32_t kNoVertex = kBlockVertices;

std::uint32_t find_or_add_vertex(BlockGeometry& block, const Vec3f& position_m) noexcept
{
    for (std::uint32_t used = block.vertices; used != 0; used &= used - 1)
    {
        const auto row = static_cast<std::uint32_t>(std::countr_zero(used));
        if (block.coordinates[0][row] == position_m[0] &&
            block.coordinates[1][row] == position_m[1] &&
            block.coordinates[2][row] == position_m[2])
        {
            return row;
        }
    }
    const auto row = static_cast<std::uint32_t>(std::countr_one(block.vertices));
    if (row < kBlockVertices)
    {
        block.vertices = static_cast<std::uint16_t>(block.vertices | (1U << row));
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            block.coordinates[axis][row] = position_m[axis];
        }
    }
    return row;
}

void drop_unused_vertices(BlockGeometry& block) noexcept
{
    std::uint32_t used = 0;
    for (std::uint32_t lanes = block.faces; lanes != 0; lanes &= lanes - 1)
    {
        const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
        used |= (1U << block.corners[0][lane]) | (1U << block.corners[1][lane]) |
                (1U << block.corners[2][lane]);
    }
    block.vertices = static_cast<std::uint16_t>(used);
}

} // namespace

std::uint32_t add_to_block(BlockGeometry& block, BlockSide& side, const ChangedFace& face) noexcept
{
    const auto lane = static_cast<std::uint32_t>(std::countr_one(block.faces));
    if (lane >= kBlockFaces)
    {
        return kBlockFaces;
    }
    const std::uint16_t vertices_before = block.vertices;
    std::array<std::uint8_t, 3> rows{};
    for (std::size_t corner = 0; corner < 3; ++corner)
    {
        const std::uint32_t row = find_or_add_vertex(block, face.corners_m[corner]);
        if (row == kNoVertex)
        {
            block.vertices = vertices_before;
            return kBlockFaces;
        }
        rows[corner] = static_cast<std::uint8_t>(row);
    }
    for (std::size_t corner = 0; corner < 3; ++corner)
    {
        block.corners[corner][lane] = rows[corner];
    }
    const std::uint32_t bit = 1U << lane;
    block.faces = static_cast<std::uint16_t>(block.faces | bit);
    side.prims[lane] = face.prim;
    side.errors[lane] = face.error;
    side.coarse =
        static_cast<std::uint16_t>(face.error == 0 ? side.coarse & ~bit : side.coarse | bit);
    return lane;
}

void remove_from_block(BlockGeometry& block, BlockSide& side, std::uint32_t lane) noexcept
{
    const std::uint32_t bit = 1U << lane;
    TACTUS_ASSERT((block.faces & bit) != 0);
    block.faces = static_cast<std::uint16_t>(block.faces & ~bit);
    side.coarse = static_cast<std::uint16_t>(side.coarse & ~bit);
    side.prims[lane] = PrimId{};
    drop_unused_vertices(block);
}

std::array<Vec3f, 3> block_triangle(const BlockGeometry& block, std::uint32_t lane) noexcept
{
    std::array<Vec3f, 3> corners{};
    for (std::size_t corner = 0; corner < 3; ++corner)
    {
        const std::size_t row = block.corners[corner][lane];
        corners[corner] = {block.coordinates[0][row], block.coordinates[1][row],
                           block.coordinates[2][row]};
    }
    return corners;
}

Aabb block_box(const BlockGeometry& block, const BlockSide& side, float quantum_m) noexcept
{
    Aabb box;
    for (std::uint32_t used = block.vertices; used != 0; used &= used - 1)
    {
        const auto row = static_cast<std::size_t>(std::countr_zero(used));
        box.add(
            Vec3f{block.coordinates[0][row], block.coordinates[1][row], block.coordinates[2][row]});
    }
    ErrorCode largest = 0;
    for (std::uint32_t lanes = side.coarse; lanes != 0; lanes &= lanes - 1)
    {
        const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
        largest = side.errors[lane] > largest ? side.errors[lane] : largest;
    }
    return largest == 0 ? box : box.inflated(error_in_quanta(largest) * quantum_m);
}

} // namespace tactus
