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
#include <cstdint>
#include <span>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// A triangle of the surface near a tool, in the model's frame. 40 B.
struct LocalTriangle
{
    PrimId prim{}; ///< Until the next frame; AbTree::face_of() knows its lasting name.
    std::array<Vec3f, 3> corners_m{};
};

/// What an answer is called (docs/accuracy.md).
enum class AnswerKind : std::uint8_t
{
    exact,   ///< L and U come from exact faces and differ by the kernel's error law only.
    decided, ///< L is above the tool's reach: there is no contact, proven without refining.
    bracket, ///< L < U and the question is open.
    stale,   ///< Of an older revision or pose than allowed; L and U hold for that one only.
    /// As exact, where coarse faces whose error is within the tolerance count as the surface: their
    /// error is taken off L, and U comes from exact faces and from corners.
    within_tolerance,
};

/// The distance from a tool's core to a model, in the model's frame and metres.
struct DistanceAnswer
{
    AnswerKind kind{AnswerKind::bracket};
    double lower_m{0.0};       ///< L: no original surface is nearer.
    double upper_m{kInfinity}; ///< U: some is within this.
    /// All original faces within this distance of the core are active and exact, or stood for by
    /// faces within the tolerance; negative when not even those that touch it are.
    double certified_radius_m{-1.0};
    /// The largest error of a face that was looked at and counts as the surface.
    double tolerated_m{0.0};
    FaceId nearest_face{}; ///< The nearest of the surface; none when there is none in reach.
    Vec3 tool_point_m{0.0, 0.0, 0.0};    ///< Of the core: the nearest one to the surface.
    Vec3 nearest_point_m{0.0, 0.0, 0.0}; ///< Of the surface.
    TriangleFeature nearest_feature{TriangleFeature::interior};
};

/// Whether the nearest place of the surface is known.
[[nodiscard]] constexpr bool is_known(AnswerKind kind) noexcept
{
    return kind == AnswerKind::exact || kind == AnswerKind::within_tolerance;
}

/// Everything the force stage needs of one pair: the triangles of the surface, exact or within the
/// tolerance, that are within the certified distance of the tool's core. In order of the traversal;
/// the force does not depend on it.
struct LocalSurface
{
    Vec3 center_m{0.0, 0.0, 0.0}; ///< Of the core, in the model's frame.
    DistanceAnswer answer;
    std::span<LocalTriangle> triangles; ///< Room; the first `count` are of the surface.
    std::span<double> distances_m;      ///< As much; lower bounds, from the core.
    std::uint32_t count{0};
    bool truncated{false}; ///< More triangles were in reach; the certified radius says how far.
    /// Room or budget ended the search: from nearer, more may be known.
    bool is_cut{false};
};
static_assert(sizeof(LocalTriangle) == 40);

} // namespace tactus
