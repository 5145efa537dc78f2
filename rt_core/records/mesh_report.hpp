// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/static_vector.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/spm/ids.hpp"

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>

// Usable on any thread: plain values and pure functions. No call waits or allocates.
namespace tactus
{

/// Two exact faces that share a point.
struct MeetingFaces
{
    FaceId tool_face{}; ///< Face of the tool's model.
    FaceId face{};      ///< Face of the object's model.

    // NOLINTNEXTLINE(modernize-use-nullptr): the check takes the comparison's zero for a pointer.
    constexpr auto operator<=>(const MeetingFaces&) const noexcept = default;
};

/// Result of the test whether any two faces of tool and object share a point.
enum class Intersection : std::uint8_t
{
    open,   ///< Unknown: faces that are not exact may meet.
    none,   ///< Proven: no faces meet.
    proven, ///< Proven: at least two faces meet.
    /// Two faces that count as the surface meet, and one is coarse within the tolerance.
    within_tolerance,
};
inline constexpr std::size_t kIntersections = 4;
static_assert(static_cast<std::size_t>(Intersection::within_tolerance) == kIntersections - 1);
/// Names in the order of Intersection.
inline constexpr std::array<const char*, kIntersections> kIntersectionNames{
    "open", "none", "proven", "within_tolerance"};

/// Results of a pair whose tool is a mesh.
struct MeshReport
{
    Intersection intersection{Intersection::open};
    /// Pairs of exact faces that meet, sorted by the tool's face id, then by the object's.
    StaticVector<MeetingFaces, kMaxMeetingFaces> meeting;
    /// True if more pairs meet. The pairs with the lowest ids are kept, or those found first if
    /// kEnoughMeetingFaces ended the search.
    bool is_truncated{false};
    bool is_complete{false}; ///< True if the report is proven to hold every pair that meets.
    /// Face of the tool at the nearest point; none if the object's nearest face is unknown.
    FaceId nearest_tool_face{};

    /// Resets the report without writing unused pairs.
    void clear() noexcept
    {
        intersection = Intersection::open;
        meeting.clear();
        is_truncated = false;
        is_complete = false;
        nearest_tool_face = {};
    }
};

} // namespace tactus
