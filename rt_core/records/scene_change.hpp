// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/object_pose.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// What happens to an object or a tool.
enum class SceneChangeKind : std::uint8_t
{
    object_comes,
    object_moves,
    object_goes,
    tool_comes,
    tool_goes,
    object_feels, ///< Otherwise from now on; what touches it feels that come within a while.
};
inline constexpr std::size_t kSceneChangeKinds = 6;

/// Whether such a change says where an object stands, or how it feels.
[[nodiscard]] constexpr bool has_pose(SceneChangeKind kind) noexcept
{
    return kind == SceneChangeKind::object_comes || kind == SceneChangeKind::object_moves;
}
[[nodiscard]] constexpr bool has_material(SceneChangeKind kind) noexcept
{
    return kind == SceneChangeKind::object_comes || kind == SceneChangeKind::object_feels;
}

/// One thing that changes in a scene, an input of a frame. Whoever makes the changes numbers the
/// objects: below the capacity, and with a generation that is higher each time that another object
/// takes a number. A change that names another generation than the object's is too old.
struct SceneChange
{
    SceneChangeKind kind{SceneChangeKind::object_moves};
    std::uint32_t number{0};     ///< Of the object, or of the tool in set-up order.
    std::uint32_t generation{0}; ///< Of the object.
    ObjectSpec object;           ///< When it comes; when it feels, its material alone.
    ObjectPose pose;             ///< When it comes or moves: of the source mesh.
};

/// Why a change was not made; the scene is as it was before.
enum class ChangeRefusal : std::uint8_t
{
    too_many,       ///< The frame has taken kMaxSceneChanges. Send later ones with later frames.
    number_too_big, ///< No such place. Raise `--objects` or `--tools`.
    already_here,   ///< Another object has the number, or the tool is there.
    not_here,       ///< There is no object of that number, or the tool is gone.
    old_generation, ///< The object that was meant is gone; or it comes with a number used before.
    unknown_model,  ///< The object shows a model that isn't there, or that is a tool.
    bad_material,   ///< Out of the ranges of Material.
    bad_pose,       ///< No rotation to kRotationTolerance, or beyond kPoseReachMax_m or a scale's.
};
inline constexpr std::size_t kChangeRefusals = 8;
/// In the order of ChangeRefusal.
inline constexpr std::array<const char*, kChangeRefusals> kChangeRefusalNames{
    "too_many",       "number_too_big", "already_here", "not_here",
    "old_generation", "unknown_model",  "bad_material", "bad_pose"};
static_assert(static_cast<std::size_t>(ChangeRefusal::bad_pose) + 1 == kChangeRefusals);

} // namespace tactus
