// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/records/scene_change.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace tactus
{

/// True if the pose is a rotation within the ranges of limits.hpp; false for NaN.
[[nodiscard]] bool is_sound(const ObjectPose& pose) noexcept TACTUS_NONBLOCKING;

/// An object of the scene.
struct Object
{
    ObjectSpec spec;
    ObjectPose pose; ///< Pose of the model's frame.
    std::uint32_t generation{0};
    std::uint32_t came_frame{0};  ///< Frame in which it was added; 0 at start.
    std::uint32_t moved_frame{0}; ///< Frame in which it was last added or moved.
    bool is_resident{false};
    bool was_here{false}; ///< The number was used before, last with `generation`.
};

/// The objects of a scene by their numbers, and the checks of their changes. Haptic thread; a
/// change costs about 0.05 us, including all consequences in a frame.
class ObjectTable
{
public:
    ObjectTable() noexcept = default;
    ObjectTable(Arena& arena, std::uint32_t capacity) noexcept
        : objects_(arena.take<Object>(capacity))
    {
    }

    /// Reason why an object's change is refused; none if it can be made. `is_shown` has an entry
    /// for each model, true if objects may show it.
    [[nodiscard]] std::optional<ChangeRefusal>
    find_refusal(const SceneChange& change,
                 std::span<const bool> is_shown) const noexcept TACTUS_NONBLOCKING;

    /// Applies a change that was not refused; `origin_m` is ModelHeader::origin_m() of its model.
    void make(const SceneChange& change, const Vec3& origin_m,
              std::uint32_t frame) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] std::uint32_t capacity() const noexcept
    {
        return static_cast<std::uint32_t>(objects_.size());
    }
    [[nodiscard]] const Object& operator[](std::uint32_t number) const noexcept
    {
        return objects_[number];
    }

private:
    std::span<Object> objects_;
};

} // namespace tactus
