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

/// Kinds of changes of objects and tools.
enum class SceneChangeKind : std::uint8_t
{
    object_comes,
    object_moves,
    object_goes,
    tool_comes,
    tool_goes,
    /// New material; tools that touch the object feel it blended in.
    object_feels,
};
inline constexpr std::size_t kSceneChangeKinds = 6;

/// True if a change of this kind has a pose; below, a material.
[[nodiscard]] constexpr bool has_pose(SceneChangeKind kind) noexcept
{
    return kind == SceneChangeKind::object_comes || kind == SceneChangeKind::object_moves;
}
[[nodiscard]] constexpr bool has_material(SceneChangeKind kind) noexcept
{
    return kind == SceneChangeKind::object_comes || kind == SceneChangeKind::object_feels;
}

/// One change of the scene, an input of a frame. The caller numbers the objects: below the
/// capacity, and with a higher generation each time that another object takes a number. A change
/// with another generation than the object's is too old.
struct SceneChange
{
    SceneChangeKind kind{SceneChangeKind::object_moves};
    std::uint32_t number{0};     ///< Number of the object, or of the tool in set-up order.
    std::uint32_t generation{0}; ///< Generation of the object.
    ObjectSpec object;           ///< Added object; only the material if that changes.
    ObjectPose pose;             ///< Pose of an added or moved object's source mesh.
};

/// Reasons why a change was refused; the scene is unchanged.
enum class ChangeRefusal : std::uint8_t
{
    /// The frame has taken kMaxSceneChanges. Send further ones with later frames.
    too_many,
    number_too_big, ///< No such number. Raise `--objects` or `--tools`.
    already_here,   ///< Another object has the number, or the tool is present.
    not_here,       ///< No object has that number, or the tool was removed.
              /// The object meant was removed, or the added one has a used number and generation.
    old_generation,
    unknown_model, ///< The object's model is unknown or a tool.
    bad_material,  ///< Material out of range.
                  /// No rotation to kRotationTolerance, or beyond kPoseReachMax_m or a limit of the
                  /// scale.
    bad_pose,
};
inline constexpr std::size_t kChangeRefusals = 8;
/// Names of the reasons, in the order of ChangeRefusal.
inline constexpr std::array<const char*, kChangeRefusals> kChangeRefusalNames{
    "too_many",       "number_too_big", "already_here", "not_here",
    "old_generation", "unknown_model",  "bad_material", "bad_pose"};
static_assert(static_cast<std::size_t>(ChangeRefusal::bad_pose) + 1 == kChangeRefusals);

} // namespace tactus
