// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/limits.hpp"
#include "rt_core/math/aabb.hpp"
#include "rt_core/records/changed_face.hpp"

#include <array>
#include <bit>
#include <cstdint>

namespace tactus
{

inline constexpr std::uint32_t kBlockFaces = 16;
inline constexpr std::uint32_t kBlockVertices = 16;

/// Geometry of one leaf: up to 16 faces over up to 16 shared vertices, four cache lines. Two mesh
/// vertices with equal coordinates share a row. 256 B.
struct alignas(64) BlockGeometry
{
    std::array<std::array<float, kBlockVertices>, 3> coordinates{}; ///< Rows x, y, z, in metres.
    std::array<std::array<std::uint8_t, kBlockFaces>, 3> corners{}; ///< Vertex of corner 0, 1, 2.
    std::uint16_t faces{0};                                         ///< Active lanes.
    std::uint16_t vertices{0};                                      ///< Used vertices.
};

static_assert(sizeof(BlockGeometry) == 256);

/// What a query reads of a block only when a lane matters, and the block's place in the tree. 96 B.
struct BlockSide
{
    std::array<PrimId, kBlockFaces> prims{};
    std::array<ErrorCode, kBlockFaces> errors{};
    std::uint32_t parent{0xFFFF'FFFFU}; ///< Node; none for a root block.
    std::uint16_t coarse{0};            ///< Lanes whose error is not 0.
    std::uint8_t child{0};              ///< Which child of the parent.
    std::uint8_t in_use{0};
    std::array<std::uint32_t, 2> reserved{};
};

static_assert(sizeof(BlockSide) == 96);

/// Adds the face's corners to free vertex rows and takes a free lane. Returns the lane, or
/// kBlockFaces with the block unchanged when faces or vertices do not fit.
[[nodiscard]] std::uint32_t add_to_block(BlockGeometry& block, BlockSide& side,
                                         const ChangedFace& face) noexcept;

void remove_from_block(BlockGeometry& block, BlockSide& side, std::uint32_t lane) noexcept;

[[nodiscard]] std::array<Vec3f, 3> block_triangle(const BlockGeometry& block,
                                                  std::uint32_t lane) noexcept;

/// Box of all faces, inflated by the block's largest error (in metres: code x quantum).
[[nodiscard]] Aabb block_box(const BlockGeometry& block, const BlockSide& side,
                             float quantum_m) noexcept;

[[nodiscard]] inline std::uint32_t face_count(const BlockGeometry& block) noexcept
{
    return static_cast<std::uint32_t>(std::popcount(block.faces));
}

} // namespace tactus
