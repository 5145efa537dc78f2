// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/triangle.hpp"
#include "rt_core/query/pair_walk.hpp"

#include <array>

namespace tactus
{

/// A block of the tool where it lies in the object's frame; without an index it is nothing.
struct PlacedBlock // NOLINT(cppcoreguidelines-pro-type-member-init): written where the index is.
{
    std::uint32_t index{kNoNode};
    double largest_error_m{0.0};                 ///< Of its faces, in the object's frame.
    std::array<Vec3, kBlockVertices> vertices_m; ///< Each coordinate rounded once or twice.
    KernelBox box;                               ///< Round the faces, errors left out.
    TriangleRows rows;                           ///< Around the box's centre.

    [[nodiscard]] Triangle triangle(const BlockGeometry& block, std::uint32_t lane) const noexcept
    {
        return {vertices_m[block.corners[0][lane]], vertices_m[block.corners[1][lane]],
                vertices_m[block.corners[2][lane]]};
    }
};

/// The tool's blocks that were placed last. Good for one query. 23 KiB.
class PlacedBlocks
{
public:
    PlacedBlocks(const AbTree& tool, const AbTree& object, const MeshPlacement& place,
                 const MeshViews& views) noexcept TACTUS_NONBLOCKING;

    /// A block in use, placed; good until the next call. About 0.2 us when it has to be placed.
    [[nodiscard]] const PlacedBlock& get(std::uint32_t index) noexcept TACTUS_NONBLOCKING;

private:
    void put(std::uint32_t index, PlacedBlock& placed) const noexcept TACTUS_NONBLOCKING;

    static constexpr std::uint32_t kKept = 16;

    const AbTree& tool_;
    const AbTree& object_;
    const MeshPlacement& place_;
    const MeshViews& views_;
    std::array<PlacedBlock, kKept> blocks_; ///< At its index modulo kKept.
};

} // namespace tactus
