// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/kernels/kernels.hpp"
#include "rt_core/math/triangle.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/spm/error_code.hpp"

#include <array>
#include <cstdint>

namespace tactus
{

class MeshViews;
struct MeshPlacement;

/// Factor that makes the rounded sum of two lengths an upper bound.
inline constexpr float kSumRoundedUp = 1.0F + 0x1p-22F;
/// Factor that keeps the length of a direction, computed in single precision, within 1.
inline constexpr float kWayRoundedDown = 1.0F - 0x1p-20F;

/// Block of the tool, placed in the object's frame; without an index it is empty.
struct PlacedBlock // NOLINT(cppcoreguidelines-pro-type-member-init): written where the index is.
{
    std::uint32_t index{kNoNode};
    std::uint32_t vertices{0}; ///< Number of vertices of the block.
    std::uint32_t faces{0};    ///< Lanes of active faces, one bit each.
    std::uint32_t coarse{0};   ///< Lanes of active faces that are not exact, one bit each.
    std::uint32_t open{0};     ///< Lanes of coarse faces with errors above the tolerance.
    KernelBox box;             ///< Box round the faces, without their errors.
    TriangleRows rows;         ///< Coordinates of the faces around the centre of the box.
    float off;                 ///< Error bound of the rows' coordinates, in quanta.
    float lowest;              ///< Lowest height of a vertex along the last requested direction.
    std::uint32_t way{0};      ///< Number of the direction of `lowest`.

    /// Error bound along any direction: at most the square root of 3 times `off`, the bound along
    /// an axis.
    [[nodiscard]] float slack() const noexcept { return 2.0F * off; }
    /// Largest error of these lanes, in quanta.
    [[nodiscard]] float largest_error(std::uint32_t lanes) const noexcept TACTUS_NONBLOCKING;
};

/// Recently placed blocks of the tool. Valid for one query. 19 KiB.
class PlacedBlocks
{
public:
    /// `tolerance` is the largest error of the tool's faces that count as the surface.
    PlacedBlocks(const AbTree& tool, const AbTree& object, const MeshPlacement& place,
                 const MeshViews& views, ErrorCode tolerance) noexcept TACTUS_NONBLOCKING;

    /// Returns a block in use, placed; valid until the next call. Takes about 60 ns if it was not
    /// placed yet.
    [[nodiscard]] const PlacedBlock& get(std::uint32_t index) noexcept TACTUS_NONBLOCKING;
    /// Places loose faces, which are in no block of the tree. `coarse` selects the lanes in use;
    /// all of them are above the tolerance. Errors are in metres of the tool's frame.
    void put_loose(const BlockGeometry& faces, std::uint32_t coarse,
                   const std::array<double, kBlockFaces>& errors_m) noexcept TACTUS_NONBLOCKING;
    /// Loose faces of the last put_loose().
    [[nodiscard]] const PlacedBlock& loose() const noexcept { return blocks_.front(); }
    /// Lower bound on the heights of the vertices of the last block along `way`, in quanta from the
    /// centre of its box. `number` names the direction, so that the result is kept; not 0.
    [[nodiscard]] float lowest_along(const Vec3f& way,
                                     std::uint32_t number) noexcept TACTUS_NONBLOCKING;
    /// lowest_along() for a direction that is used once.
    [[nodiscard]] float lowest_along(const Vec3f& way) const noexcept TACTUS_NONBLOCKING;

private:
    [[nodiscard]] double object_quantum_m() const noexcept
    {
        return static_cast<double>(object_.quantum_m());
    }
    void put(std::uint32_t index, PlacedBlock& placed) const noexcept TACTUS_NONBLOCKING;
    void put(const BlockGeometry& block, PlacedBlock& placed) const noexcept TACTUS_NONBLOCKING;

    static constexpr std::uint32_t kKept = 16;

    const AbTree& tool_;
    const AbTree& object_;
    const MeshPlacement& place_;
    const MeshViews& views_;
    ErrorCode tolerance_;
    std::uint32_t last_{0};                 ///< Index in blocks_ of the last block.
    std::array<PlacedBlock, kKept> blocks_; ///< Placed blocks, each at its index modulo kKept.
};

} // namespace tactus
