// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/object_pose.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

// Usable on any thread: plain values and pure functions. No call waits or allocates.
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
    /// The object gets a new material, which tools in contact feel blended in.
    object_feels,
};
inline constexpr std::size_t kSceneChangeKinds = 6;

/// True if a change of this kind has a pose, or, for has_material(), a material.
[[nodiscard]] constexpr bool has_pose(SceneChangeKind kind) noexcept
{
    return kind == SceneChangeKind::object_comes || kind == SceneChangeKind::object_moves;
}
[[nodiscard]] constexpr bool has_material(SceneChangeKind kind) noexcept
{
    return kind == SceneChangeKind::object_comes || kind == SceneChangeKind::object_feels;
}

/// One change of the scene, an input of a frame. The caller chooses object numbers below the
/// capacity, and a higher generation each time it uses a number again. A change with another
/// generation than the object's is refused.
struct SceneChange
{
    SceneChangeKind kind{SceneChangeKind::object_moves};
    std::uint32_t number{0};     ///< Number of the object, or of the tool in set-up order.
    std::uint32_t generation{0}; ///< Generation of the object.
    /// Model and material of an added object; only the material for object_feels.
    ObjectSpec object;
    ObjectPose pose; ///< Pose of an added or moved object's source mesh.
};

/// Reasons why a change was refused; the scene is unchanged.
enum class ChangeRefusal : std::uint8_t
{
    /// The frame has taken kMaxSceneChanges already. Send the change with a later frame.
    too_many,
    /// No object or tool can have this number. Raise `--objects` or `--tools`.
    number_too_big,
    /// Another object has the number, or the tool is present.
    already_here,
    /// No object has the number, or the tool was removed.
    not_here,
    /// The object meant was removed, or the added one has a used number and generation.
    old_generation,
    /// The object's model does not exist or belongs to a tool.
    unknown_model,
    /// The material is out of range.
    bad_material,
    /// No rotation to kRotationTolerance, or beyond kPoseReachMax_m or a limit of the scale.
    bad_pose,
};
inline constexpr std::size_t kChangeRefusals = 8;
/// Names of the reasons, in the order of ChangeRefusal.
inline constexpr std::array<const char*, kChangeRefusals> kChangeRefusalNames{
    "too_many",       "number_too_big", "already_here", "not_here",
    "old_generation", "unknown_model",  "bad_material", "bad_pose"};
static_assert(static_cast<std::size_t>(ChangeRefusal::bad_pose) + 1 == kChangeRefusals);

} // namespace tactus
