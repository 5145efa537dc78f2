// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/triangle.hpp"
#include "rt_core/query/pair_walk.hpp"

#include <array>

namespace tactus
{

/// More than the sum of two lengths that is rounded once, as a share of it.
inline constexpr float kSumRoundedUp = 1.0F + 0x1p-22F;

/// A block of the tool where it lies in the object's frame; without an index it is nothing.
struct PlacedBlock // NOLINT(cppcoreguidelines-pro-type-member-init): written where the index is.
{
    std::uint32_t index{kNoNode};
    std::uint32_t vertices{0}; ///< Rows in use.
    std::uint32_t faces{0};    ///< Its active lanes,
    std::uint32_t coarse{0};   ///< and which of them are not exact.
    KernelBox box;             ///< Round the faces, errors left out.
    TriangleRows rows;         ///< Around the box's centre.
    float off;                 ///< What a coordinate of theirs is off by at most, in quanta.
    float lowest;              ///< None is lower along the way that was asked for last,
    std::uint32_t way{0};      ///< which is this one.

    /// Along a direction, an error along each axis makes up to the square root of 3.
    [[nodiscard]] float slack() const noexcept { return 2.0F * off; }
    /// Of these lanes, in quanta.
    [[nodiscard]] float largest_error(std::uint32_t lanes) const noexcept TACTUS_NONBLOCKING;
};

/// The tool's blocks that were placed last. Good for one query. 19 KiB.
class PlacedBlocks
{
public:
    PlacedBlocks(const AbTree& tool, const AbTree& object, const MeshPlacement& place,
                 const MeshViews& views) noexcept TACTUS_NONBLOCKING;

    /// A block in use, placed; good until the next call. About 60 ns when it has to be placed.
    [[nodiscard]] const PlacedBlock& get(std::uint32_t index) noexcept TACTUS_NONBLOCKING;
    /// Faces that are in no block, placed; `coarse` are those of them that are meant, and their
    /// errors are lengths of the tool's frame.
    void put_loose(const BlockGeometry& faces, std::uint32_t coarse,
                   const std::array<double, kBlockFaces>& errors_m) noexcept TACTUS_NONBLOCKING;
    /// As they were put last.
    [[nodiscard]] const PlacedBlock& loose() const noexcept { return blocks_.front(); }
    /// No vertex of the block that get() gave last is lower along `way`, in quanta from its box's
    /// centre. Ways differ by their number, which is not 0.
    [[nodiscard]] float lowest_along(const Vec3f& way,
                                     std::uint32_t number) noexcept TACTUS_NONBLOCKING;
    /// The same of a way that is asked for once.
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
    std::uint32_t last_{0};                 ///< Its place there.
    std::array<PlacedBlock, kKept> blocks_; ///< At its index modulo kKept.
};

} // namespace tactus
