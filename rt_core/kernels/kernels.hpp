// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/seen_triangle.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

// Any thread: the functions depend on their arguments alone; no call waits or allocates.
namespace tactus
{

/// A query point in single precision, split so that a coordinate's difference from it is right to a
/// few units in the last place.
struct KernelProbe
{
    // NOLINTBEGIN(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays): kernel_source.inc.
    float high[3]; ///< Point rounded to float, in metres.
    float low[3];  ///< Remainder of the rounding.
    // NOLINTEND(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays)
    float scale; ///< 1 / quantum, a power of two: kernels work and answer in quanta.
    float slack; ///< Error of `high` + `low`, in quanta; part of every bound.
};

static_assert(sizeof(KernelProbe) == 32);

/// Bounds on the distances from the probe to the 16 faces of a block, in quanta, one lane per face.
/// Lanes without a face hold meaningless values.
struct FaceBounds
{
    // NOLINTBEGIN(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays): kernel_source.inc.
    alignas(64) float lower[16];
    /// Upper bounds on the distance to the nearest corner; only for faces that are not exact.
    alignas(64) float corner[16];
    // NOLINTEND(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays)
};

/// A rotated box, such as a mesh tool's, for comparison with boxes of a tree's frame. Lengths are
/// around its centre, in units shared by both frames.
struct KernelBox
{
    KernelProbe center; ///< Centre; `scale` is units per metre, `slack` includes the box's
                        ///< rounding.
    // NOLINTBEGIN(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays): kernel_source.inc.
    float half[3];       ///< Half extents along the axes of the tree's frame.
    float half_along[3]; ///< Half extents along its own axes.
    float axes[3][3];    ///< Its own axes, of unit length to rounding.
    // NOLINTEND(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays)
};

/// The faces of a block, one lane each, with the data that bounds the distance of two faces from
/// below. In quanta, around one point. 1 KiB.
struct TriangleRows
{
    // NOLINTBEGIN(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays): kernel_source.inc.
    alignas(64) float vertex[3][16]; ///< Coordinates by the block's rows.
    float low[3][16];                ///< Low and high corners of the faces' boxes.
    float high[3][16];
    float normal[3][16]; ///< Normals, of unit length to rounding; zero for a face without one.
    float plane_low[16]; ///< Least and greatest height of the face's own corners along the normal.
    float plane_high[16];
    float error[16];             ///< Error bound between the face and the surface that it stands
                                 ///< for.
    std::uint8_t corners[3][16]; ///< Row of each corner.
    // NOLINTEND(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays)
};

/// A block's vertices around a point, in quanta, and the sum of each vertex's absolute coordinates.
struct VertexRows
{
    // NOLINTBEGIN(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays): kernel_source.inc.
    alignas(64) float at[3][16];
    float size[16];
    // NOLINTEND(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays)
};

/// Pairs of faces, one lane each: corners 0 to 2 of the tool's and 3 to 5 of the object's, around
/// the object's first one, which is therefore zero. In quanta.
inline constexpr std::uint32_t kPairLanes = 8;
struct PairRows
{
    // NOLINTBEGIN(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays): kernel_source.inc.
    alignas(64) float at[6][3][kPairLanes];
    float off[kPairLanes]; ///< Error bound of each coordinate; kLeastPairOff or more.
    // NOLINTEND(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays)
};
inline constexpr float kLeastPairOff = 0x1p-40F;

/// Pairs proven to meet, and proven not to, in single precision; one bit each. A pair may have
/// neither bit.
struct PairSides
{
    std::uint32_t meet;
    std::uint32_t apart;
};

/// Bounds on the distances of pairs, in quanta.
struct PairDistances
{
    // NOLINTBEGIN(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays): kernel_source.inc.
    alignas(64) float lower[kPairLanes];
    float upper[kPairLanes];
    float way[3][kPairLanes]; ///< Direction from the object to the tool; zero if none was found.
    // NOLINTEND(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays)
};

/// Nodes, and blocks with coarse faces, that a breadth-first traversal found and still has to
/// visit. The kernels write whole vectors, so there are eight places more than are used. 3.4 KB on
/// the stack.
struct Frontier
{
    /// Number of waiting items up to which the first found is visited first. Beyond it the last
    /// found comes first, so each level adds no more items than to a depth-first stack.
    static constexpr std::uint32_t kBroad = 256;
    static constexpr std::uint32_t kRoom = kBroad + kTreeStack + 8;

    std::uint32_t count;
    // NOLINTBEGIN(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays): kernel_source.inc.
    std::uint32_t refs[kRoom]; ///< TreeRefs.
    float gaps[kRoom];         ///< Lower bounds on the distances of their boxes, in quanta.
    // NOLINTEND(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays)
};

/// Blocks whose faces are all exact, tested together. 4.2 KB on the stack.
struct BlockBatch
{
    static constexpr std::uint32_t kFull = 32; ///< The batch is tested before it grows further.
    static constexpr std::uint32_t kRoom = kFull + 2 * 8;

    std::uint32_t count;
    // NOLINTBEGIN(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays): kernel_source.inc.
    std::uint32_t blocks[kRoom]; ///< TreeRefs.
    float gaps[kRoom];           ///< Lower bounds on the distances of their boxes, in quanta.
    float toward[3][kRoom];      ///< Vectors from the probe towards their boxes' middles, of any
                                 ///< length.
    std::uint16_t near[kRoom];   ///< Faces that test_blocks() finds near.
    /// Lower bounds on all faces' squared distances; may be negative.
    alignas(64) float lower_sq[kRoom][16];
    // NOLINTEND(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays)
};

/// Eight faces, one lane each, with a plane before each of them. The distance of a face from any
/// place is at least the place's height above its plane, normal . place + offset. A face without a
/// computed plane has cone 1 and its distance from the centre as offset; its height is the offset
/// minus the place's distance from the centre. A lane without a face has the largest height. In
/// quanta, around a centre. 160 B.
inline constexpr std::uint32_t kPlaneLanes = 8;
struct PlaneRows
{
    // NOLINTBEGIN(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays): kernel_source.inc.
    alignas(32) float normal[3][kPlaneLanes]; ///< Direction from the face to the sphere.
    float offset[kPlaneLanes];
    float cone[kPlaneLanes];
    // NOLINTEND(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays)
};
static_assert(sizeof(PlaneRows) == 160);
/// Upper limit of a plane's offset.
inline constexpr float kFarPlane = 0x1p100F;

/// Lanes of a batch whose planes were computed from the stand with this number (PlaneQuestion).
struct PlaneSeen
{
    std::uint32_t stand;
    std::uint32_t lanes;
};

/// Faces of one model in batches of kPlaneLanes.
struct PlaneTable
{
    KernelProbe center; ///< Centre of all coordinates.
    std::uint32_t count;
    PlaneRows* planes;
    PlaneSeen* seen;
    /// Lower bound on the heights of each batch at the last question's place. Padded with kFarPlane
    /// to a multiple of eight.
    float* lows;
    /// First face of each batch, as LocalTriangle lies in memory.
    const void* const* triangles;
};

/// Places of the sphere's centre are in quanta around the table's centre, rounded to float from
/// double.
struct PlaneQuestion
{
    // NOLINTBEGIN(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays): kernel_source.inc.
    float place[3];
    float stand[3]; ///< Place of the sphere's centre from which planes are computed.
    // NOLINTEND(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays)
    std::uint32_t stand_number; ///< Number of the stand, above 0; each new stand has another.
    float drift;                ///< Upper bound on the distance between the places of the last
                                ///< question and this one.
    float least;                ///< Height below which faces are reported.
    /// Height at the stand below which faces are reported. Less than `least` if the sphere is deep
    /// in faces: a motion out of them is then free if it nowhere comes nearer than this.
    float least_here;
};

/// Results of planes_below().
struct PlaneCounts
{
    std::uint32_t hits;
    std::uint32_t looked; ///< Batches with newly computed planes.
};

/// Faces of one batch that are below the heights that the question sets.
struct PlaneHit
{
    // NOLINTNEXTLINE(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays): likewise.
    float heights[kPlaneLanes]; ///< Heights of all lanes.
    float low;                  ///< Least of the heights.
    std::uint32_t batch;
    std::uint32_t lanes; ///< Lanes of these faces, one bit each.
};

/// Box of an index page for near_boxes(), relative to a point, in quanta.
struct KernelPage
{
    // NOLINTBEGIN(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays): kernel_source.inc.
    float low[3];  ///< Low corner of the page's box, from which its boxes count their steps.
    float step[3]; ///< Length of a step.
    // NOLINTEND(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays)
    float slack; ///< Upper bound on the rounding of any gap.
};
/// Number of boxes in a row of an index page: three rows of low steps, then three of high ones.
inline constexpr int kIndexRow = 64;

/// A sphere for near_boxes(), relative to the same point, in quanta.
struct KernelSphere
{
    // NOLINTNEXTLINE(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays): likewise.
    float center[3];
    float radius;
};

/// Relation of eight boxes to a set of spheres.
struct NearBoxes
{
    std::uint32_t met;  ///< Boxes that a sphere surely meets.
    std::uint32_t open; ///< Boxes that single precision can't decide.
    float gap;          ///< Lower bound on the gap between the spheres and the other boxes.
};

/// Layout of a LocalTriangle: its name, then three coordinates of each corner.
inline constexpr std::size_t kTriangleBytes = 40;
inline constexpr std::size_t kTriangleCornersAt = 4;

/// Layout of a block in the tree's array, for the point kernels: three rows of 16 floats, three of
/// 16 bytes, and two masks of 16 bits.
inline constexpr std::size_t kBlockBytes = 256;
inline constexpr std::size_t kBlockCornersAt = 192;
inline constexpr std::size_t kBlockFacesAt = 240;
inline constexpr std::size_t kBlockVerticesAt = 242;

static_assert(sizeof(FaceBounds) == 128);
static_assert(sizeof(TriangleRows) == 1024);

/// The inner loops of query and refit, one set for each instruction set. A program only chooses the
/// set (FrameSetup::kernels).
///
/// `boxes` are six rows of eight floats, low x, y, z, high x, y, z; `coordinates` three rows of 16
/// floats; both in metres. `corners` are three rows of 16 row numbers, `gaps` eight floats in
/// quanta. Bit n of a mask is child, face, vertex or lane n. Nothing is checked.
///
/// Kernels filter and do not decide: bounds are conservative by a stated margin, and cases within
/// it are decided in double precision elsewhere. Every set does the same IEEE operations in the
/// same order on each lane, without FMA or estimated reciprocals. So all give the same bits (except
/// for the sign of a box bound that is zero).
struct Kernels
{
    const char* name; ///< Name in reports; static.

    /// Writes to `gaps` lower bounds on the probe's distances from the boxes of a node's eight
    /// children; `boxes` are AbNode's six rows. Returns the children in `mask` whose bound is not
    /// above `bound`.
    std::uint32_t (*child_gaps)(const float* boxes, const KernelProbe& probe, std::uint32_t mask,
                                float bound, float* gaps) noexcept TACTUS_NONBLOCKING;

    /// Bounds on the distances to the faces in `mask` of a block: `coordinates` and `corners` are
    /// BlockGeometry's rows. The least upper bound of those that are also in `exact` lowers
    /// `limit`. Returns the faces whose lower bound is not above the larger of `floor` and the new
    /// `limit`.
    ///
    /// A lower bound is less than the distance by at most 2 kFaceMargin x the local length (the
    /// longest of edges and distances to the corners). Faces of an aspect above kThinAspect lose
    /// another 1/kThinAspect x the longest edge.
    std::uint32_t (*face_bounds)(const float* coordinates, const std::uint8_t* corners,
                                 const KernelProbe& probe, std::uint32_t mask, std::uint32_t exact,
                                 float floor, float& limit,
                                 FaceBounds& bounds) noexcept TACTUS_NONBLOCKING;

    /// Adds the children in `mask` whose bound from child_gaps() is not above `bound`: blocks that
    /// are not in `coarse` to the batch, others to the frontier, each in their order. `children`
    /// are eight TreeRefs. Batch and frontier must have eight free places each.
    void (*enter_node)(const float* boxes, const std::uint32_t* children, const KernelProbe& probe,
                       std::uint32_t mask, std::uint32_t coarse, float bound, Frontier& frontier,
                       BlockBatch& batch) noexcept TACTUS_NONBLOCKING;

    /// Removes the block `known` (a TreeRef) from the batch. Also removes blocks whose vertices all
    /// lie farther than `bound` from the probe along the direction to the box's middle: then all
    /// their faces do. The box of a slanted block protrudes from the surface, its faces don't.
    /// `blocks` is the tree's array.
    void (*sort_out)(const void* blocks, const KernelProbe& probe, std::uint32_t known, float bound,
                     BlockBatch& batch) noexcept TACTUS_NONBLOCKING;

    /// face_bounds() of all blocks in the batch, in squares. The least upper bound lowers `limit`.
    /// Faces are near if their lower bound is not above the larger of `floor` and the new `limit`.
    /// All distances are quanta.
    ///
    /// The bounds on a squared distance are off by at most 2 kSquareMargin x the squared distance
    /// of the farthest corner. This holds for faces of an aspect up to 8. Thinner ones may be
    /// farther than their lower bound, those above kSquareThinAspect by 1/kSquareThinAspect x the
    /// longest edge.
    void (*test_blocks)(const void* blocks, const KernelProbe& probe, float floor, float& limit,
                        BlockBatch& batch) noexcept TACTUS_NONBLOCKING;

    /// see_triangle() of math/seen_triangle.hpp, with all three edges at once.
    void (*see_triangle)(const double* query, const double* triangle,
                         SeenTriangle& seen) noexcept TACTUS_NONBLOCKING;

    /// Box of the vertices in `mask` of a block: low x, y, z, high x, y, z. Exact.
    void (*block_box)(const float* coordinates, std::uint32_t mask,
                      float* box) noexcept TACTUS_NONBLOCKING;

    /// Union of the boxes of the children in `mask`. Exact.
    void (*node_box)(const float* boxes, std::uint32_t mask,
                     float* box) noexcept TACTUS_NONBLOCKING;

    /// Writes to `gaps` lower bounds on the distances from a box to the boxes of a node's eight
    /// children: the larger of the gaps along both frames' axes. Returns the children in `mask`
    /// whose bound is not above `bound`.
    std::uint32_t (*box_gaps)(const float* boxes, const KernelBox& box, std::uint32_t mask,
                              float bound, float* gaps) noexcept TACTUS_NONBLOCKING;

    /// Raises the bounds `gaps` of box_gaps() to the boxes' gaps along the direction `way`, not
    /// longer than 1, from the node to the box. Otherwise as box_gaps().
    std::uint32_t (*boxes_along)(const float* boxes, const KernelBox& box, const float* way,
                                 std::uint32_t mask, float bound,
                                 float* gaps) noexcept TACTUS_NONBLOCKING;

    /// Writes to `rows` the faces of a block, translated and rotated: `coordinates` less `from`,
    /// times the 3 x 3 of `turn`, row by row. A coordinate is off by less than 2^-21 of the sum of
    /// the differences' sizes, times the largest of `turn`. `coordinates` and `corners` are
    /// BlockGeometry's rows.
    void (*place_turned)(const float* coordinates, const std::uint8_t* corners, const float* from,
                         const float* turn, TriangleRows& rows) noexcept TACTUS_NONBLOCKING;

    /// Upper bound on the heights of the vertices in `mask` above the probe, along a direction not
    /// longer than 1, without the probe's slack. `mask` is not empty. `coordinates` are three rows
    /// of 16.
    float (*highest_along)(const float* coordinates, std::uint32_t mask, const KernelProbe& probe,
                           const float* way) noexcept TACTUS_NONBLOCKING;

    /// Returns the faces in `mask` not proven to be farther from a box than `bound` plus their
    /// error, along the frame's axes and their normals. `box` is low x, y, z, high x, y, z in
    /// metres; `center` is the rows' centre. `slack` is the error of their vertices beyond 2^-22 of
    /// their size. If none is left, all in `mask` are at least `least_gap` away, errors subtracted.
    std::uint32_t (*near_rows)(const TriangleRows& rows, const float* box,
                               const KernelProbe& center, std::uint32_t mask, float bound,
                               float slack, float& least_gap) noexcept TACTUS_NONBLOCKING;

    /// Returns the faces in `mask` of a block not proven to be farther than `bound` from a box,
    /// along both frames' axes. Writes to `rows` the block's vertices around the box's centre.
    std::uint32_t (*near_block)(const float* coordinates, const std::uint8_t* corners,
                                const KernelBox& box, std::uint32_t mask, float bound,
                                VertexRows& rows) noexcept TACTUS_NONBLOCKING;

    /// Writes to near[lane], for each tool face `lane` in `tool_mask`, the faces in `mask` not
    /// proven to be farther from it than `bound` plus its error. Tested along the frame's axes, the
    /// tool face's normal, and `way`: from the object to the tool, not longer than 1, null if
    /// unknown. Both rows are around the same point; `slack` is as in near_rows().
    void (*near_pairs)(const VertexRows& rows, const std::uint8_t* corners, std::uint32_t mask,
                       const TriangleRows& tool, std::uint32_t tool_mask, float bound, float slack,
                       const float* way, std::uint32_t* near) noexcept TACTUS_NONBLOCKING;

    /// Writes to `hits`, in the batches' order, the faces that a sphere of radius `least` may enter
    /// on a straight motion from the stand to the place. A plane too low at the place is first
    /// computed again from the stand, once per stand. Heights in `hits` are at the place, or at the
    /// stand if that is lower and below `least_here`. A face without a hit is free at the place,
    /// and at the stand if the stand was used before. `hits` has places for all batches.
    PlaneCounts (*planes_below)(const PlaneTable& table, const PlaneQuestion& question,
                                PlaneHit* hits) noexcept TACTUS_NONBLOCKING;

    /// The least height of all planes at the question's place; kFarPlane if there is none.
    float (*least_height)(const PlaneTable& table,
                          const PlaneQuestion& question) noexcept TACTUS_NONBLOCKING;

    /// Finds which pairs in the first `count` lanes surely meet and which surely don't.
    PairSides (*decide_pairs)(const PairRows& rows,
                              std::uint32_t count) noexcept TACTUS_NONBLOCKING;

    /// Writes bounds on the distances of the pairs in the first `count` lanes. A pair's lower bound
    /// is the gap along its `way`.
    void (*pair_distances)(const PairRows& rows, std::uint32_t count,
                           PairDistances& distances) noexcept TACTUS_NONBLOCKING;

    /// Finds which of eight boxes of an index page meet one of `count` spheres; boxes in `known`
    /// are left out. `steps` is the place of the first box in the page's first row.
    NearBoxes (*near_boxes)(const std::uint16_t* steps, const KernelPage& page,
                            const KernelSphere* spheres, std::uint32_t count,
                            std::uint32_t known) noexcept TACTUS_NONBLOCKING;
};

/// Rounding of the bounds between boxes and between faces in single precision, as a share of the
/// sum of their coordinates around the common point. Exceeds all roundings together
/// (kernel_pairs.inc).
inline constexpr float kPairMargin = 0x1p-19F;

/// Aspect (longest edge squared / twice the area) above which face_bounds() bounds a face by its
/// edges alone, and the margin of its bounds.
inline constexpr float kThinAspect = 128.0F;
inline constexpr float kFaceMargin = 4e-5F;

/// Limits for test_blocks(), whose bounds are squares. docs/internals/proofs.md proves them.
inline constexpr float kSquareThinAspect = 32.0F;
inline constexpr float kSquareMargin = 0x1p-15F;
/// Rounding of the test whether the probe lies over a face, as a share of the farthest corner's
/// distance x the cube of the longest edge.
inline constexpr float kInsideMargin = 0x1p-17F;

/// The kernels that run on every processor. All sets are static.
[[nodiscard]] const Kernels& portable_kernels() noexcept;
/// The kernel sets that this processor runs, the fastest last. Queries the processor: for start-up.
[[nodiscard]] std::span<const Kernels* const> available_kernels() noexcept;
/// The fastest set; also for start-up.
[[nodiscard]] inline const Kernels& best_kernels() noexcept
{
    return *available_kernels().back();
}

} // namespace tactus
