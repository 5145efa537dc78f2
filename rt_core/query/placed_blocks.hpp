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
    std::uint32_t vertices{0};   ///< Rows in use.
    std::uint32_t faces{0};      ///< Its active lanes,
    std::uint32_t coarse{0};     ///< and which of them are not exact.
    double largest_error_m{0.0}; ///< Of its faces, in the object's frame.
    KernelBox box;               ///< Round the faces, errors left out.
    TriangleRows rows;           ///< Around the box's centre.
    float off;                   ///< What a coordinate of theirs is off by at most, in quanta.
    float lowest;                ///< None is lower along the way that was asked for last,
    std::uint32_t way{0};        ///< which is this one.

    /// Along a direction, an error along each axis makes up to the square root of 3.
    [[nodiscard]] float slack() const noexcept { return 2.0F * off; }
};

/// The tool's blocks that were placed last. Good for one query. 18 KiB.
class PlacedBlocks
{
public:
    PlacedBlocks(const AbTree& tool, const AbTree& object, const MeshPlacement& place,
                 const MeshViews& views) noexcept TACTUS_NONBLOCKING;

    /// A block in use, placed; good until the next call. About 60 ns when it has to be placed.
    [[nodiscard]] const PlacedBlock& get(std::uint32_t index) noexcept TACTUS_NONBLOCKING;
    /// No vertex of the block that get() gave last is lower along `way`, in quanta from its box's
    /// centre. Ways differ by their number, which is not 0.
    [[nodiscard]] float lowest_along(const Vec3f& way,
                                     std::uint32_t number) noexcept TACTUS_NONBLOCKING;

private:
    void put(std::uint32_t index, PlacedBlock& placed) const noexcept TACTUS_NONBLOCKING;

    static constexpr std::uint32_t kKept = 16;

    const AbTree& tool_;
    const AbTree& object_;
    const MeshPlacement& place_;
    const MeshViews& views_;
    std::uint32_t last_{0};                 ///< Its place there.
    std::array<PlacedBlock, kKept> blocks_; ///< At its index modulo kKept.
};

} // namespace tactus
