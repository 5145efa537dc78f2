// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/abtree/block.hpp"

#include <cstring>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace tactus
{

namespace
{

constexpr std::uint32_t kNoVertex = kBlockVertices;

using FourFloats = float __attribute__((vector_size(16)));

using FourInts = std::int32_t __attribute__((vector_size(16)));

/// One bit a lane, of lanes that are all ones or all zeros.
std::uint32_t bits_of(FourInts lanes) noexcept
{
#if defined(__SSE2__)
    return static_cast<std::uint32_t>(_mm_movemask_ps(reinterpret_cast<__m128>(lanes)));
#else
    return static_cast<std::uint32_t>((lanes[0] & 1) | (lanes[1] & 2) | (lanes[2] & 4) |
                                      (lanes[3] & 8));
#endif
}

/// One bit for each used row that holds the position.
std::uint32_t rows_at(const BlockGeometry& block, const Vec3f& position_m) noexcept
{
    std::uint32_t rows = 0;
    for (std::uint32_t first = 0; first < kBlockVertices; first += 4)
    {
        FourFloats x;
        FourFloats y;
        FourFloats z;
        std::memcpy(&x, &block.coordinates[0][first], sizeof x);
        std::memcpy(&y, &block.coordinates[1][first], sizeof y);
        std::memcpy(&z, &block.coordinates[2][first], sizeof z);
        const auto same = (x == position_m[0]) & (y == position_m[1]) & (z == position_m[2]);
        rows |= bits_of(same) << first;
    }
    return rows & block.vertices;
}

std::uint32_t find_or_add_vertex(BlockGeometry& block, const Vec3f& position_m) noexcept
{
    if (const std::uint32_t same = rows_at(block, position_m); same != 0)
    {
        return static_cast<std::uint32_t>(std::countr_zero(same));
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

void set_error(BlockSide& side, std::uint32_t lane, ErrorCode error) noexcept
{
    const std::uint32_t bit = 1U << lane;
    side.errors[lane] = error;
    side.coarse = static_cast<std::uint16_t>(error == 0 ? side.coarse & ~bit : side.coarse | bit);
}

/// Rows for the corners; false when there are not enough.
bool try_place(BlockGeometry& block, const std::array<Vec3f, 3>& corners_m,
               std::array<std::uint8_t, 3>& rows) noexcept
{
    for (std::size_t corner = 0; corner < 3; ++corner)
    {
        const std::uint32_t row = find_or_add_vertex(block, corners_m[corner]);
        if (row == kNoVertex)
        {
            return false;
        }
        rows[corner] = static_cast<std::uint8_t>(row);
    }
    return true;
}

} // namespace

std::uint32_t add_to_block(BlockGeometry& block, BlockSide& side, const ChangedFace& face) noexcept
{
    const auto lane = static_cast<std::uint32_t>(std::countr_one(block.faces));
    if (lane >= kBlockFaces)
    {
        return kBlockFaces;
    }
    std::array<std::uint8_t, 3> rows{};
    if (!try_place(block, face.corners_m, rows))
    {
        drop_unused_vertices(block);
        if (!try_place(block, face.corners_m, rows))
        {
            drop_unused_vertices(block);
            return kBlockFaces;
        }
    }
    for (std::size_t corner = 0; corner < 3; ++corner)
    {
        block.corners[corner][lane] = rows[corner];
    }
    block.faces = static_cast<std::uint16_t>(block.faces | (1U << lane));
    side.prims[lane] = face.prim;
    set_error(side, lane, face.error);
    return lane;
}

bool move_corner_in_block(BlockGeometry& block, BlockSide& side, std::uint32_t lane,
                          std::uint32_t corner, const Vec3f& position_m, ErrorCode error) noexcept
{
    std::uint32_t row = find_or_add_vertex(block, position_m);
    if (row == kNoVertex)
    {
        drop_unused_vertices(block);
        row = find_or_add_vertex(block, position_m);
        if (row == kNoVertex)
        {
            return false;
        }
    }
    block.corners[corner][lane] = static_cast<std::uint8_t>(row);
    set_error(side, lane, error);
    return true;
}

void remove_from_block(BlockGeometry& block, BlockSide& side, std::uint32_t lane) noexcept
{
    const std::uint32_t bit = 1U << lane;
    TACTUS_ASSERT((block.faces & bit) != 0);
    block.faces = static_cast<std::uint16_t>(block.faces & ~bit);
    side.coarse = static_cast<std::uint16_t>(side.coarse & ~bit);
    side.prims[lane] = PrimId{};
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

float largest_error_quanta(const BlockSide& side) noexcept
{
    ErrorCode largest = 0;
    for (std::uint32_t lanes = side.coarse; lanes != 0; lanes &= lanes - 1)
    {
        const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
        largest = side.errors[lane] > largest ? side.errors[lane] : largest;
    }
    return error_in_quanta(largest);
}

} // namespace tactus
