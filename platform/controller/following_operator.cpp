// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/controller/following_operator.hpp"

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

FollowingOperator::FollowingOperator(std::unique_ptr<OperatorMotion> motion,
                                     const ObjectTable& objects, std::uint32_t object,
                                     const Similarity& start, double step_max_m)
    : motion_(std::move(motion))
    , objects_(objects)
    , object_(object)
    , start_(start)
    , step_max_m_(step_max_m)
{
}

void FollowingOperator::update_way() noexcept
{
    const Object& object = objects_[object_];
    if (!object.is_resident || (!has_moved_ && are_equal(object.pose, start_)))
    {
        return;
    }
    has_moved_ = true;
    const Similarity before = way_;
    way_.scale = object.pose.scale / start_.scale;
    way_.rotation = object.pose.rotation * start_.rotation.transpose();
    way_.translation_m =
        object.pose.translation_m - way_.scale * (way_.rotation * start_.translation_m);
    // The operator moves with the object. A step above step_max_m_ goes into the offset late_m_
    // instead, which then shrinks.
    const Vec3 here_m = start_.translation_m;
    const Vec3 step_m = way_.local_to_world(here_m) - before.local_to_world(here_m);
    late_m_ -= step_m.norm() > step_max_m_ ? step_m : Vec3(Vec3::Zero());
}

Vec3 FollowingOperator::next_world_m(const OperatorSense& sense) noexcept
{
    update_way();
    if (!has_moved_)
    {
        return motion_->next_world_m(sense);
    }
    const double late_m = late_m_.norm();
    late_m_ *= late_m > step_max_m_ ? (late_m - step_max_m_) / late_m : 0.0;
    OperatorSense sensed = sense;
    sensed.device_world_m = way_.world_to_local(sense.device_world_m - late_m_);
    sensed.force_world_n = way_.rotation.transpose() * sense.force_world_n;
    sensed.torque_world_nm = way_.rotation.transpose() * sense.torque_world_nm;
    sensed.device_rotation = way_.rotation.transpose() * sense.device_rotation;
    return way_.local_to_world(motion_->next_world_m(sensed)) + late_m_;
}

OperatorGrip FollowingOperator::grip() const noexcept
{
    OperatorGrip grip = motion_->grip();
    if (has_moved_)
    {
        grip.rotation = way_.rotation * grip.rotation;
    }
    return grip;
}

} // namespace tactus::hrtc
