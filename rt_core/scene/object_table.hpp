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

/// Whether an object can stand so; false for what is no number, too.
[[nodiscard]] bool is_sound(const ObjectPose& pose) noexcept TACTUS_NONBLOCKING;

/// An object of the scene.
struct Object
{
    ObjectSpec spec;
    ObjectPose pose; ///< Of the model's frame.
    std::uint32_t generation{0};
    std::uint32_t came_frame{0};  ///< In which it came; 0 of those that a frame starts with.
    std::uint32_t moved_frame{0}; ///< In which it came or moved last.
    bool is_here{false};
    bool was_here{false}; ///< The number has been used, and `generation` was the last.
};

/// The objects of a scene by their numbers, and the check of what is to become of them. Haptic
/// thread; a change costs some 0.05 us, all that follows from it in a frame included.
class ObjectTable
{
public:
    ObjectTable() noexcept = default;
    ObjectTable(Arena& arena, std::uint32_t capacity) noexcept
        : objects_(arena.take<Object>(capacity))
    {
    }

    /// Why the change of an object can't be made; none where it can. Of the models it may show each
    /// has a true in `is_shown`.
    [[nodiscard]] std::optional<ChangeRefusal>
    find_refusal(const SceneChange& change,
                 std::span<const bool> is_shown) const noexcept TACTUS_NONBLOCKING;

    /// Makes a change that was not refused; `origin_m` is that of the object's model.
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
