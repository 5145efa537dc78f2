// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/static_vector.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/spm/ids.hpp"

#include <compare>
#include <cstdint>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
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
    open,   ///< Faces that are not exact may meet.
    none,   ///< Proven that none meet.
    proven, ///< Some faces meet.
};

/// Results of a pair whose tool is a mesh.
struct MeshReport
{
    Intersection intersection{Intersection::open};
    /// Exact faces; lowest ids first, the tool's before the object's.
    StaticVector<MeetingFaces, kMaxMeetingFaces> meeting;
    /// More met: those with the lowest ids are kept; with kEnoughMeetingFaces those found first.
    bool is_truncated{false};
    bool is_complete{false}; ///< No pair was left out, and none may exist unseen.
    /// The tool's face at the nearest point, if the object's is known.
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
