// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/triangle.hpp"
#include "rt_core/query/pair_walk.hpp"

#include <array>

namespace tactus
{

/// Factor above the rounding of a sum of two lengths.
inline constexpr float kSumRoundedUp = 1.0F + 0x1p-22F;

/// A block of the tool, placed in the object's frame; empty without an index.
struct PlacedBlock // NOLINT(cppcoreguidelines-pro-type-member-init): written where the index is.
{
    std::uint32_t index{kNoNode};
    std::uint32_t vertices{0}; ///< Number of rows in use.
    std::uint32_t faces{0};    ///< Active lanes.
    std::uint32_t coarse{0};   ///< Active lanes that are not exact.
    KernelBox box;             ///< Box round the faces, errors left out.
    TriangleRows rows;         ///< Rows around the box's centre.
    float off;                 ///< Error bound of the rows' coordinates, in quanta.
    float lowest;              ///< Lowest height along the last requested direction.
    std::uint32_t way{0};      ///< Number of that direction.

    /// Error along a direction: up to the square root of 3 times that along an axis.
    [[nodiscard]] float slack() const noexcept { return 2.0F * off; }
    /// Largest error of these lanes, in quanta.
    [[nodiscard]] float largest_error(std::uint32_t lanes) const noexcept TACTUS_NONBLOCKING;
};

/// The last placed blocks of the tool. Valid for one query. 19 KiB.
class PlacedBlocks
{
public:
    PlacedBlocks(const AbTree& tool, const AbTree& object, const MeshPlacement& place,
                 const MeshViews& views) noexcept TACTUS_NONBLOCKING;

    /// A block in use, placed; valid until the next call. Takes about 60 ns if it has to be placed.
    [[nodiscard]] const PlacedBlock& get(std::uint32_t index) noexcept TACTUS_NONBLOCKING;
    /// Places faces that are in no block. `coarse` selects the lanes in use. Errors are lengths in
    /// the tool's frame.
    void put_loose(const BlockGeometry& faces, std::uint32_t coarse,
                   const std::array<double, kBlockFaces>& errors_m) noexcept TACTUS_NONBLOCKING;
    /// The last placed loose faces.
    [[nodiscard]] const PlacedBlock& loose() const noexcept { return blocks_.front(); }
    /// Lower bound on the heights of the last block's vertices along `way`, in quanta from its
    /// box's centre. `number` identifies the direction and is not 0.
    [[nodiscard]] float lowest_along(const Vec3f& way,
                                     std::uint32_t number) noexcept TACTUS_NONBLOCKING;
    /// The same for a direction that is used once.
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
    std::uint32_t last_{0};                 ///< Slot of the last block.
    std::array<PlacedBlock, kKept> blocks_; ///< Slots, at the block's index modulo kKept.
};

} // namespace tactus
