// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/abtree/block.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/math/four_lanes.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <utility>

namespace tactus
{

namespace
{

constexpr std::uint32_t kNoVertex = kBlockVertices;

using Bytes = std::uint8_t __attribute__((vector_size(kBlockFaces)));

/// Gathers one bit per byte; each byte must be all ones or all zeros.
std::uint32_t bits_of_bytes(Bytes lanes) noexcept
{
#ifdef __SSE2__
    return static_cast<std::uint32_t>(_mm_movemask_epi8(reinterpret_cast<__m128i>(lanes)));
#else
    std::uint32_t bits = 0;
    for (std::uint32_t i = 0; i < kBlockFaces; ++i)
    {
        bits |= (lanes[i] & 1U) << i;
    }
    return bits;
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

/// Frees the row unless an active lane still has a corner there.
void drop_unless_used(BlockGeometry& block, std::uint8_t row) noexcept
{
    std::uint32_t lanes = 0;
    for (const std::array<std::uint8_t, kBlockFaces>& corners : block.corners)
    {
        Bytes rows;
        std::memcpy(&rows, corners.data(), sizeof rows);
        lanes |= bits_of_bytes(reinterpret_cast<Bytes>(rows == row));
    }
    if ((lanes & block.faces) == 0)
    {
        block.vertices = static_cast<std::uint16_t>(block.vertices & ~(1U << row));
    }
}

/// Sets the error of a face that is not outdated.
void set_error(BlockSide& side, std::uint32_t lane, ErrorCode error) noexcept
{
    const std::uint32_t bit = 1U << lane;
    side.errors[lane] = error;
    side.coarse = static_cast<std::uint16_t>(error == 0 ? side.coarse & ~bit : side.coarse | bit);
    side.outdated = static_cast<std::uint16_t>(side.outdated & ~bit);
}

/// Bits of `lanes` of a mask, moved to the first lanes.
std::uint16_t gather(std::uint16_t mask, std::uint32_t lanes) noexcept
{
    std::uint32_t gathered = 0;
    for (std::uint32_t to = 0; lanes != 0; lanes &= lanes - 1, ++to)
    {
        gathered |= ((std::uint32_t{mask} >> std::countr_zero(lanes)) & 1U) << to;
    }
    return static_cast<std::uint16_t>(gathered);
}

/// Keeps only the faces in `lanes` and moves them to the first lanes: a kernel skips an empty
/// second half.
void keep_lanes(BlockGeometry& block, BlockSide& side, std::uint32_t lanes) noexcept
{
    std::size_t to = 0;
    std::uint32_t used = 0;
    side.coarse = gather(side.coarse, lanes);
    side.outdated = side.outdated == 0 ? std::uint16_t{0} : gather(side.outdated, lanes);
    for (std::uint32_t left = lanes; left != 0; left &= left - 1, ++to)
    {
        const auto from = static_cast<std::size_t>(std::countr_zero(left));
        for (std::array<std::uint8_t, kBlockFaces>& corners : block.corners)
        {
            corners[to] = corners[from];
            used |= 1U << corners[to];
        }
        side.errors[to] = side.errors[from];
        side.prims[to] = side.prims[from];
    }
    std::fill(side.prims.begin() + static_cast<std::ptrdiff_t>(to), side.prims.end(), PrimId{});
    block.faces = static_cast<std::uint16_t>((1U << to) - 1U);
    block.vertices = static_cast<std::uint16_t>(used);
}

} // namespace

std::uint32_t add_to_block(BlockGeometry& block, BlockSide& side, const ChangedFace& face) noexcept
{
    TACTUS_ASSERT(!face.prim.is_none());
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
    block.faces = static_cast<std::uint16_t>(block.faces | (1U << lane));
    side.prims[lane] = face.prim;
    set_error(side, lane, face.error);
    if (face.is_outdated)
    {
        side.coarse = static_cast<std::uint16_t>(side.coarse | (1U << lane));
        side.outdated = static_cast<std::uint16_t>(side.outdated | (1U << lane));
    }
    return lane;
}

bool move_corner_in_block(BlockGeometry& block, BlockSide& side, std::uint32_t lane,
                          std::uint32_t corner, const Vec3f& position_m, ErrorCode error) noexcept
{
    TACTUS_ASSERT(((std::uint32_t{block.faces} >> lane) & 1U) != 0);
    const std::uint32_t row = find_or_add_vertex(block, position_m);
    if (row == kNoVertex)
    {
        return false;
    }
    const std::uint8_t left =
        std::exchange(block.corners[corner][lane], static_cast<std::uint8_t>(row));
    drop_unless_used(block, left);
    set_error(side, lane, error);
    return true;
}

void remove_from_block(BlockGeometry& block, BlockSide& side, std::uint32_t lane) noexcept
{
    const std::uint32_t bit = 1U << lane;
    TACTUS_ASSERT((block.faces & bit) != 0);
    block.faces = static_cast<std::uint16_t>(block.faces & ~bit);
    side.coarse = static_cast<std::uint16_t>(side.coarse & ~bit);
    side.outdated = static_cast<std::uint16_t>(side.outdated & ~bit);
    side.prims[lane] = PrimId{};
    for (std::size_t corner = 0; corner < 3; ++corner)
    {
        drop_unless_used(block, block.corners[corner][lane]);
    }
}

void halve_block(BlockGeometry& block, BlockSide& side, std::uint32_t moved, BlockGeometry& other,
                 BlockSide& other_side) noexcept
{
    TACTUS_ASSERT((moved & ~std::uint32_t{block.faces}) == 0);
    TACTUS_ASSERT(other.faces == 0);
    other = block;
    other_side.prims = side.prims;
    other_side.errors = side.errors;
    other_side.coarse = side.coarse;
    other_side.outdated = side.outdated;
    keep_lanes(block, side, block.faces & ~moved);
    keep_lanes(other, other_side, moved);
}

std::uint32_t lanes_above(const BlockSide& side, ErrorCode tolerance) noexcept
{
    Bytes errors;
    std::memcpy(&errors, side.errors.data(), sizeof errors);
    return (side.coarse & bits_of_bytes(reinterpret_cast<Bytes>(errors > tolerance))) |
           side.outdated;
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
