// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/controller/following_hand.hpp"

#include <algorithm>
#include <utility>

namespace tactus::hrtc
{

namespace
{

bool are_equal(const Similarity& a, const Similarity& b) noexcept
{
    return a.scale == b.scale && a.translation_m == b.translation_m && a.rotation == b.rotation;
}

} // namespace

FollowingHand::FollowingHand(std::unique_ptr<HandMotion> hand, const ObjectTable& objects,
                             std::uint32_t object, const Similarity& start, double step_max_m)
    : hand_(std::move(hand))
    , objects_(objects)
    , object_(object)
    , start_(start)
    , step_max_m_(step_max_m)
{
}

void FollowingHand::look() noexcept
{
    const Object& object = objects_[object_];
    if (!object.is_here || (!has_moved_ && are_equal(object.pose, start_)))
    {
        return;
    }
    has_moved_ = true;
    const Similarity before = way_;
    way_.scale = object.pose.scale / start_.scale;
    way_.rotation = object.pose.rotation * start_.rotation.transpose();
    way_.translation_m =
        object.pose.translation_m - way_.scale * (way_.rotation * start_.translation_m);
    // What lies round the object's place goes with it, but for what is too much for one step.
    const Vec3 here_m = start_.translation_m;
    const Vec3 step_m = way_.to_there(here_m) - before.to_there(here_m);
    late_m_ -= step_m.norm() > step_max_m_ ? step_m : Vec3(Vec3::Zero());
}

Vec3 FollowingHand::next_world_m(const HandSense& sense) noexcept
{
    look();
    if (!has_moved_)
    {
        return hand_->next_world_m(sense);
    }
    const double late_m = late_m_.norm();
    late_m_ *= late_m > step_max_m_ ? (late_m - step_max_m_) / late_m : 0.0;
    HandSense sensed = sense;
    sensed.device_world_m = way_.to_here(sense.device_world_m - late_m_);
    sensed.force_world_n = way_.rotation.transpose() * sense.force_world_n;
    sensed.torque_world_nm = way_.rotation.transpose() * sense.torque_world_nm;
    sensed.device_rotation = way_.rotation.transpose() * sense.device_rotation;
    return way_.to_there(hand_->next_world_m(sensed)) + late_m_;
}

HandGrip FollowingHand::grip() const noexcept
{
    HandGrip grip = hand_->grip();
    if (has_moved_)
    {
        grip.rotation = way_.rotation * grip.rotation;
    }
    return grip;
}

} // namespace tactus::hrtc
