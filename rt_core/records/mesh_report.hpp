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
    FaceId tool_face{}; ///< Of the tool's model.
    FaceId face{};      ///< Of the object's.

    // NOLINTNEXTLINE(modernize-use-nullptr): the check takes the comparison's zero for a pointer.
    constexpr auto operator<=>(const MeetingFaces&) const noexcept = default;
};

/// Whether any two faces of tool and object share a point.
enum class Intersection : std::uint8_t
{
    open,   ///< What is not exact may meet.
    none,   ///< Proven.
    proven, ///< Some do.
};

/// What a tool that is a mesh gets of a pair.
struct MeshReport
{
    Intersection intersection{Intersection::open};
    /// Of exact faces, lowest ids first: by the tool's and then by the object's.
    StaticVector<MeetingFaces, kMaxMeetingFaces> meeting;
    /// More met: those with the lowest ids are kept; of kEnoughMeetingFaces those found first.
    bool is_truncated{false};
    bool is_complete{false}; ///< None was left out, and none may exist unseen.
    /// The tool's face at the nearest point, where the object's is known.
    FaceId nearest_tool_face{};

    /// As new, without touching what no pair is in.
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
