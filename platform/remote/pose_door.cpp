// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/remote/pose_door.hpp"

#include "rt_core/base/assert.hpp"

#include <algorithm>

namespace tactus
{

PoseDoor::PoseDoor(std::span<const ObjectPose> placed, Duration age_limit)
    : age_limit_(age_limit)
    , poses_(placed.begin(), placed.end())
    , letters_(placed.size())
    , uses_(placed.size())
{
    TACTUS_ASSERT(placed.size() <= kMaxObjects);
}

void PoseDoor::put(std::size_t object, const ObjectPose& pose, MonotonicTime arrival) noexcept
{
    TACTUS_ASSERT(object < letters_.size());
    Letter letter;
    for (int i = 0; i < 9; ++i)
    {
        letter.rotation[static_cast<std::size_t>(i)] = pose.rotation(i / 3, i % 3);
    }
    const Vec3& at_m = pose.translation_m;
    letter.translation_m = {at_m.x(), at_m.y(), at_m.z()};
    letter.scale = pose.scale;
    letter.stamp_ns = pose.stamp_ns;
    letter.revision = pose.revision;
    letter.arrival_ns = arrival.ns;
    letter.number = ++numbers_[object];
    mailboxes_[object].write(letter);
}

void PoseDoor::refresh(MonotonicTime now) noexcept
{
    for (std::size_t i = 0; i < poses_.size(); ++i)
    {
        const std::uint64_t known = letters_[i].number;
        if (mailboxes_[i].try_read(letters_[i]) && letters_[i].number != known)
        {
            move_to(i, pose_of(letters_[i]));
        }
        if (uses_[i].is_followed)
        {
            age(i, now);
        }
    }
}

ObjectPose PoseDoor::pose_of(const Letter& letter) noexcept
{
    ObjectPose pose;
    for (int i = 0; i < 9; ++i)
    {
        pose.rotation(i / 3, i % 3) = letter.rotation[static_cast<std::size_t>(i)];
    }
    const auto& at_m = letter.translation_m;
    pose.translation_m = Vec3(at_m[0], at_m[1], at_m[2]);
    pose.scale = letter.scale;
    pose.stamp_ns = letter.stamp_ns;
    pose.revision = letter.revision;
    return pose;
}

void PoseDoor::move_to(std::size_t object, const ObjectPose& pose) noexcept
{
    const ObjectPose& before = poses_[object];
    PoseUse& use = uses_[object];
    const bool has_moved = pose.translation_m != before.translation_m ||
                           pose.rotation != before.rotation || pose.scale != before.scale;
    use.moves += has_moved ? 1U : 0U;
    use.step_max_m = std::max(use.step_max_m, (pose.translation_m - before.translation_m).norm());
    use.is_followed = true;
    poses_[object] = pose;
}

void PoseDoor::age(std::size_t object, MonotonicTime now) noexcept
{
    // A pose that came since the frame began is not from the future.
    const Duration age{std::max<std::int64_t>(now.ns - letters_[object].arrival_ns, 0)};
    poses_[object].age_ns = age.ns;
    PoseUse& use = uses_[object];
    use.age_max = std::max(use.age_max, age);
    use.old_frames += age > age_limit_ ? 1U : 0U;
}

} // namespace tactus
