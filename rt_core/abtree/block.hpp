// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/kernels/kernels.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/changed_face.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tactus
{

inline constexpr std::uint32_t kBlockFaces = 16;
inline constexpr std::uint32_t kBlockVertices = 16;
static_assert(kBlockFaces <= 16, "a block's lanes are bits of 16");
static_assert(kBlockVertices <= 16, "and so are its rows");

/// Geometry of one leaf: up to 16 faces over up to 16 shared vertices, four cache lines. Two mesh
/// vertices with equal coordinates share a row. 256 B.
struct alignas(64) BlockGeometry
{
    std::array<std::array<float, kBlockVertices>, 3> coordinates{}; ///< Rows x, y, z, in metres.
    std::array<std::array<std::uint8_t, kBlockFaces>, 3> corners{}; ///< Row of corner 0, 1, 2.
    std::uint16_t faces{0};    ///< Lanes with a face, one bit each.
    std::uint16_t vertices{0}; ///< Rows with a vertex, one bit each.
};

static_assert(sizeof(BlockGeometry) == kBlockBytes);
static_assert(offsetof(BlockGeometry, coordinates) == 0);
static_assert(offsetof(BlockGeometry, corners) == kBlockCornersAt);
static_assert(offsetof(BlockGeometry, faces) == kBlockFacesAt);
static_assert(offsetof(BlockGeometry, vertices) == kBlockVerticesAt);

/// Data of a block that a query reads only if a lane matters, and the block's place in the tree. 96
/// B.
struct BlockSide
{
    std::array<PrimId, kBlockFaces> prims{};
    std::array<ErrorCode, kBlockFaces> errors{};
    /// Parent node, kNoNode for a root block; the next free block while this one is free.
    std::uint32_t parent{0xFFFF'FFFFU};
    std::uint32_t link{0xFFFF'FFFFU}; ///< Next block that waits for refit.
    /// Lanes of faces that are not exact: their error is not 0, or they are outdated.
    std::uint16_t coarse{0};
    std::uint8_t child{0}; ///< Index as child of the parent.
    bool in_use{false};
    bool is_marked{false}; ///< True while in the list of marked blocks, even once freed.
    std::uint8_t owner{0}; ///< Model of the block's tree.
    /// Lanes of coarse faces that may stand for removed ones (ChangedFace::is_outdated).
    std::uint16_t outdated{0};
};

static_assert(sizeof(BlockSide) == 96);

/// Adds the face's corners to free vertex rows and takes a free lane. Returns the lane, or
/// kBlockFaces with the faces unchanged if faces or vertices do not fit.
[[nodiscard]] std::uint32_t add_to_block(BlockGeometry& block, BlockSide& side,
                                         const ChangedFace& face) noexcept TACTUS_NONBLOCKING;

/// Moves one corner of a face to another position and changes the face's error. The face is not
/// outdated afterwards. False, with the face unchanged, if the block has no row for the position.
[[nodiscard]] bool move_corner_in_block(BlockGeometry& block, BlockSide& side, std::uint32_t lane,
                                        std::uint32_t corner, const Vec3f& position_m,
                                        ErrorCode error) noexcept TACTUS_NONBLOCKING;

/// Removes an active face, with the rows that only it used.
void remove_from_block(BlockGeometry& block, BlockSide& side,
                       std::uint32_t lane) noexcept TACTUS_NONBLOCKING;

/// Moves the faces of the lanes `moved` to `other`, an unused block. Both blocks' faces then occupy
/// their first lanes.
void halve_block(BlockGeometry& block, BlockSide& side, std::uint32_t moved, BlockGeometry& other,
                 BlockSide& other_side) noexcept TACTUS_NONBLOCKING;

[[nodiscard]] inline std::array<Vec3f, 3> block_triangle(const BlockGeometry& block,
                                                         std::uint32_t lane) noexcept
{
    TACTUS_ASSERT(lane < kBlockFaces);
    std::array<Vec3f, 3> corners{};
    for (std::size_t corner = 0; corner < 3; ++corner)
    {
        const std::size_t row = block.corners[corner][lane];
        corners[corner] = {block.coordinates[0][row], block.coordinates[1][row],
                           block.coordinates[2][row]};
    }
    return corners;
}

/// The largest error of the block's faces, in quanta.
[[nodiscard]] float largest_error_quanta(const BlockSide& side) noexcept TACTUS_NONBLOCKING;

/// Lanes that do not count as the surface, one bit each: their error exceeds `tolerance`, or they
/// are outdated. For 0 those of BlockSide::coarse.
[[nodiscard]] std::uint32_t lanes_above(const BlockSide& side,
                                        ErrorCode tolerance) noexcept TACTUS_NONBLOCKING;

/// Number of set bits among a block's 16 lanes. std::popcount is a library call where the processor
/// may lack the instruction.
[[nodiscard]] inline std::uint32_t count_lanes(std::uint32_t bits) noexcept
{
    bits -= (bits >> 1U) & 0x5555U;
    bits = (bits & 0x3333U) + ((bits >> 2U) & 0x3333U);
    bits = (bits + (bits >> 4U)) & 0x0F0FU;
    return (bits + (bits >> 8U)) & 31U;
}

[[nodiscard]] inline std::uint32_t face_count(const BlockGeometry& block) noexcept
{
    return count_lanes(block.faces);
}

} // namespace tactus
