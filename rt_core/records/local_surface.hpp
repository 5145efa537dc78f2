// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/limits.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/triangle.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/changed_face.hpp"
#include "rt_core/spm/ids.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

// Usable on any thread: plain values and pure functions. No call waits or allocates.
namespace tactus
{

/// A triangle of the surface near a tool, in the model's frame. 40 B.
struct LocalTriangle
{
    PrimId prim{}; ///< Valid until the next frame; AbTree::face_of() gives the lasting id.
    std::array<Vec3f, 3> corners_m{};
};

/// Kinds of answers (docs/accuracy.md).
enum class AnswerKind : std::uint8_t
{
    /// L and U come from exact faces and differ only by the kernel's error law and, with a
    /// tolerance, by 2^-20 quanta within which faces count as equally near.
    exact,
    /// No contact: L is above the tool's reach, proven without refining.
    separated,
    /// Only the bounds L < U on the distance are proven; contact is undecided.
    bounded,
    /// The pose is too old or of another model revision; L and U hold for that pose only.
    stale,
    /// Like exact, but coarse faces with an error within the tolerance count as the surface: their
    /// error is subtracted from L, and U comes from exact faces and from corners.
    within_tolerance,
};
inline constexpr std::size_t kAnswerKinds = 5;
/// Names of the kinds, in the order of AnswerKind.
inline constexpr std::array<const char*, kAnswerKinds> kAnswerNames{"exact", "separated", "bounded",
                                                                    "stale", "within_tolerance"};
static_assert(static_cast<std::size_t>(AnswerKind::within_tolerance) == kAnswerKinds - 1);

/// The distance from a tool's core to a model, in the model's frame and metres.
struct DistanceAnswer
{
    AnswerKind kind{AnswerKind::bounded};
    double lower_m{0.0};       ///< L: no original surface is nearer.
    double upper_m{kInfinity}; ///< U: some surface is within this distance.
    /// All original faces within this distance of the core are active and exact, or represented by
    /// faces within the tolerance; negative if not even the touching faces are.
    double certified_radius_m{-1.0};
    /// The largest error of a face that was checked and counts as the surface, plus the change of
    /// the answer that faces may cause which were not measured.
    double tolerated_m{0.0};
    FaceId nearest_face{};               ///< Nearest face; none if none is in reach.
    Vec3 tool_point_m{0.0, 0.0, 0.0};    ///< Nearest point of the core.
    Vec3 nearest_point_m{0.0, 0.0, 0.0}; ///< Nearest point of the surface.
    TriangleFeature nearest_feature{TriangleFeature::interior};
};

/// True for the kinds of answers that name the nearest point of the surface.
[[nodiscard]] constexpr bool is_known(AnswerKind kind) noexcept
{
    return kind == AnswerKind::exact || kind == AnswerKind::within_tolerance;
}

/// Data of one pair for the force stage: the triangles of the surface, exact or within the
/// tolerance, that are within the certified distance of the tool's core. The traversal order of the
/// triangles does not affect the force.
struct LocalSurface
{
    Vec3 center_m{0.0, 0.0, 0.0}; ///< Centre of the core, in the model's frame.
    DistanceAnswer answer;
    /// Memory for triangles; the first `count` are the surface's.
    std::span<LocalTriangle> triangles;
    /// Lower bounds on the distances of these triangles from the core.
    std::span<double> distances_m;
    std::uint32_t count{0};
    /// True if triangles in reach did not fit. The certified radius then ends before them.
    bool truncated{false};
    /// True if capacity or budget ended the search; a query from a nearer place may find more.
    bool is_cut{false};
};
static_assert(sizeof(LocalTriangle) == 40);

} // namespace tactus
