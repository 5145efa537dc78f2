// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tactus
{

/// The point of a query as the kernels see it: in single precision, split so that a coordinate's
/// difference from it is right to a few units in the last place.
struct KernelProbe
{
    // NOLINTBEGIN(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays): kernel_source.inc.
    float high[3]; ///< The point rounded to float, in metres.
    float low[3];  ///< What the rounding left.
    // NOLINTEND(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays)
    float scale; ///< 1 / quantum, a power of two: kernels work and answer in quanta.
    float slack; ///< What `high` and `low` leave of the point, in quanta; in every bound.
};

static_assert(sizeof(KernelProbe) == 32);

/// Bounds on the distances from the probe to the 16 faces of a block, in quanta: one lane a face;
/// lanes without a face hold values of no meaning.
struct FaceBounds
{
    // NOLINTBEGIN(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays): kernel_source.inc.
    alignas(64) float lower[16];
    /// Upper bounds on the distance to the nearest corner; only of faces that are not exact.
    alignas(64) float corner[16];
    // NOLINTEND(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays)
};

/// A box of another frame as the kernels see it, turned as it is; around its centre, in units that
/// both frames share.
struct KernelBox
{
    KernelProbe center; ///< `scale` is units a metre; `slack` holds what is rounded of the box.
    // NOLINTBEGIN(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays): kernel_source.inc.
    float half[3];       ///< Half its extent along the axes of this frame.
    float half_along[3]; ///< Half its extent along its own axes,
    float axes[3][3];    ///< which are these, of unit length to rounding.
    // NOLINTEND(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays)
};

/// The faces of a block, one lane each, with all that bounds the distance of two faces from below.
/// In quanta, around some point. 960 B.
struct TriangleRows
{
    // NOLINTBEGIN(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays): kernel_source.inc.
    alignas(64) float vertex[3][16]; ///< By the block's rows.
    float low[3][16];                ///< Of the faces' boxes.
    float high[3][16];
    float normal[3][16]; ///< Of unit length to rounding, or zero of a face that has none.
    float plane_low[16]; ///< Least and greatest height of the face's own corners along it.
    float plane_high[16];
    std::uint8_t corners[3][16]; ///< Row of each corner.
    // NOLINTEND(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays)
};

static_assert(sizeof(FaceBounds) == 128);
static_assert(sizeof(TriangleRows) == 960);

/// The inner loops of query and refit, in one set for each instruction set.
///
/// They filter, they do not decide: bounds are conservative by a stated margin, and what lies
/// within it is decided in double precision elsewhere. Every set does the same IEEE operations in
/// the same order on each lane, without FMA or estimated reciprocals, so all give the same bits (of
/// a box bound that is zero, but for its sign).
struct Kernels
{
    const char* name;

    /// Lower bounds on the distances to the boxes of a node's eight children: `boxes` is AbNode's
    /// six rows. Returns the children in `mask` whose bound is not above `bound`.
    std::uint32_t (*child_gaps)(const float* boxes, const KernelProbe& probe, std::uint32_t mask,
                                float bound, float* gaps) noexcept TACTUS_NONBLOCKING;

    /// Bounds on the distances to the faces in `mask` of a block: `coordinates` and `corners` are
    /// BlockGeometry's rows. The least upper bound of those that are also in `exact` lowers
    /// `limit`; returns the faces whose lower bound is not above the larger of `floor` and the new
    /// `limit`.
    ///
    /// A lower bound is less than the distance by at most 2 kFaceMargin x the local length (the
    /// longest of edges and distances to the corners); for faces of an aspect above kThinAspect by
    /// another 1/kThinAspect x the longest edge.
    std::uint32_t (*face_bounds)(const float* coordinates, const std::uint8_t* corners,
                                 const KernelProbe& probe, std::uint32_t mask, std::uint32_t exact,
                                 float floor, float& limit,
                                 FaceBounds& bounds) noexcept TACTUS_NONBLOCKING;

    /// Box of the vertices in `mask` of a block: low x, y, z, high x, y, z. Exact.
    void (*block_box)(const float* coordinates, std::uint32_t mask,
                      float* box) noexcept TACTUS_NONBLOCKING;

    /// Union of the boxes of the children in `mask`. Exact.
    void (*node_box)(const float* boxes, std::uint32_t mask,
                     float* box) noexcept TACTUS_NONBLOCKING;

    /// Lower bounds on the distances from a box to the boxes of a node's eight children: the larger
    /// of what separates them along the axes of the one and of the other. Returns the children in
    /// `mask` whose bound is not above `bound`.
    std::uint32_t (*box_gaps)(const float* boxes, const KernelBox& box, std::uint32_t mask,
                              float bound, float* gaps) noexcept TACTUS_NONBLOCKING;

    /// The faces of a block around the probe; `coordinates` and `corners` are BlockGeometry's rows.
    void (*place_triangles)(const float* coordinates, const std::uint8_t* corners,
                            const KernelProbe& probe,
                            TriangleRows& rows) noexcept TACTUS_NONBLOCKING;

    /// The faces in `mask` whose boxes are not proven to be farther than `bound` from a box. `rows`
    /// are around its centre.
    std::uint32_t (*near_faces)(const TriangleRows& rows, const KernelBox& box, std::uint32_t mask,
                                float bound) noexcept TACTUS_NONBLOCKING;

    /// The faces in `mask` whose boxes are not proven to be farther than `bound` from one round all
    /// faces in `other_mask`, of which there are some. Both rows are around the same point; `slack`
    /// is what their coordinates are off beyond 2^-22 of themselves.
    std::uint32_t (*near_lanes)(const TriangleRows& rows, const TriangleRows& other,
                                std::uint32_t other_mask, std::uint32_t mask, float bound,
                                float slack) noexcept TACTUS_NONBLOCKING;

    /// Lower bounds on the distances from face `lane` of `other` to the faces in `mask`: the
    /// largest of what separates them along the frame's axes and along the normal of either.
    /// Returns the faces whose bound is not above `bound`; other lanes hold values of no meaning.
    /// Rows and `slack` as above.
    std::uint32_t (*triangle_gaps)(const TriangleRows& rows, const TriangleRows& other,
                                   std::uint32_t lane, std::uint32_t mask, float bound, float slack,
                                   float* gaps) noexcept TACTUS_NONBLOCKING;
};

/// What single precision rounds in the bounds between boxes and between faces, as a share of the
/// sum of their coordinates around the common point; more than all roundings together.
inline constexpr float kPairMargin = 0x1p-20F;

/// Faces with a larger (longest edge squared / twice the area) are bounded by their edges alone.
inline constexpr float kThinAspect = 128.0F;
inline constexpr float kFaceMargin = 4e-5F;

/// Runs everywhere.
[[nodiscard]] const Kernels& portable_kernels() noexcept;
/// The sets that this processor runs, the fastest last. Looks at the processor: for start-up.
[[nodiscard]] std::span<const Kernels* const> available_kernels() noexcept;
[[nodiscard]] inline const Kernels& best_kernels() noexcept
{
    return *available_kernels().back();
}

} // namespace tactus
