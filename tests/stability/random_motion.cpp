// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/stability/random_motion.hpp"

#include "tests/shared/period.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::test
{

namespace
{

/// Speeds for frames of 1 ms.
constexpr double kSlowest_diag = 0.05e-3;
constexpr double kFastest_diag = 2e-3;
constexpr double kTap_diag = 0.015;
constexpr std::uint32_t kShakeFrames = 40;
constexpr double kFastestSpin_rad = 0.02;
constexpr std::uint32_t kLongest = 90;

} // namespace

const std::array<RandomMotion::Activity, 7> RandomMotion::kActivities{{
    {"rest", &RandomMotion::begin_nothing, &RandomMotion::rest},
    {"slide", &RandomMotion::begin_slide, &RandomMotion::slide},
    {"tap", &RandomMotion::begin_tap, &RandomMotion::tap},
    {"flight", &RandomMotion::begin_flight, &RandomMotion::fly},
    {"jump", &RandomMotion::begin_jump, &RandomMotion::rest},
    {"spin", &RandomMotion::begin_spin, &RandomMotion::spin},
    {"carry", &RandomMotion::carry_object, &RandomMotion::rest},
}};

RandomMotion::RandomMotion(const TestModel& model, const FaceTree& tree, double radius_m,
                           double scale, Random& random)
    : model_(model), tree_(tree), radius_m_(radius_m), random_(random)
{
    moment_.pose.scale = scale;
    begin_jump();
}

void RandomMotion::tap_up_to(double speed_m_per_s)
{
    const double angular_speed = 2.0 * std::numbers::pi / (kShakeFrames * kPeriod_s);
    farthest_tap_m_ = speed_m_per_s / angular_speed / moment_.pose.scale;
}

Moment RandomMotion::next()
{
    if (frames_left_ == 0)
    {
        activity_ = random_.below(kActivities.size());
        frame_ = 0;
        frames_left_ = 5 + random_.below(kLongest);
        (this->*kActivities[activity_].begin)();
    }
    (this->*kActivities[activity_].go_on)();
    ++frame_;
    --frames_left_;
    return moment_;
}

Vec3 RandomMotion::random_corner()
{
    return to_vec3(model_.faces[random_.below(model_.faces.size())][random_.below(3)]);
}

void RandomMotion::hold_at(const Vec3& place_m)
{
    place_ = place_m;
    moment_.goal_m = to_world(moment_.pose, place_m);
}

void RandomMotion::begin_slide()
{
    SlideManner manner;
    manner.diagonal_m = model_.diagonal_m;
    manner.radius_diag = std::min(0.05, radius_m_ / model_.diagonal_m);
    manner.step_m = random_.between(kSlowest_diag, kFastest_diag) * model_.diagonal_m;
    manner.rotation_rate = [rate = random_.between(-1.0, 1.0)](std::uint64_t) { return rate; };
    const Vec3 corner = random_corner();
    slide_.emplace(tree_, manner, Vec3(corner + random_.in_cube(0.01 * model_.diagonal_m)));
}

void RandomMotion::slide()
{
    hold_at(slide_->next());
}

void RandomMotion::begin_tap()
{
    place_ = random_corner();
    direction_ = random_.in_cube(1.0).normalized();
    const double usual = kTap_diag * model_.diagonal_m;
    tap_m_ = farthest_tap_m_ > 0.0 ? random_.between(0.0, farthest_tap_m_) : usual;
}

/// Taps through the surface and back.
void RandomMotion::tap()
{
    const double phase = 2.0 * std::numbers::pi * frame_ / kShakeFrames;
    moment_.goal_m = to_world(moment_.pose, Vec3(place_ + tap_m_ * std::cos(phase) * direction_));
}

void RandomMotion::begin_flight()
{
    place_ = to_model(moment_.pose, moment_.goal_m);
    direction_ = random_.in_cube(kFastest_diag * model_.diagonal_m);
}

void RandomMotion::fly()
{
    hold_at(place_ + direction_);
}

/// Jumps mostly near the surface, sometimes anywhere around the model.
void RandomMotion::begin_jump()
{
    const double off = random_.one_in(5) ? 0.7 : 0.01;
    const Vec3 corner = random_corner();
    hold_at(corner + random_.in_cube(off * model_.diagonal_m));
}

void RandomMotion::begin_spin()
{
    pivot_world_ = moment_.goal_m + random_.in_cube(0.3 * moment_.pose.scale * model_.diagonal_m);
    pivot_ = to_model(moment_.pose, pivot_world_);
    axis_ = random_.in_cube(1.0).normalized();
    rate_rad_ = random_.between(-kFastestSpin_rad, kFastestSpin_rad);
    rotation_before_ = moment_.pose.rotation;
}

/// Rotates by the whole angle at once: products of small rotations would drift from orthonormal
/// matrices.
void RandomMotion::spin()
{
    ObjectPose& pose = moment_.pose;
    const Mat3 turned = Eigen::AngleAxisd(rate_rad_ * (frame_ + 1), axis_) * rotation_before_;
    pose.rotation = Eigen::Quaterniond(turned).normalized().toRotationMatrix();
    pose.translation_m = pivot_world_ - pose.scale * (pose.rotation * pivot_);
}

/// Puts a place of the surface at the goal, often with the proxy inside the model.
void RandomMotion::carry_object()
{
    ObjectPose& pose = moment_.pose;
    pose.rotation = Eigen::Quaterniond{random_.between(0.1, 1.0), random_.between(-1.0, 1.0),
                                       random_.between(-1.0, 1.0), random_.between(-1.0, 1.0)}
                        .normalized()
                        .toRotationMatrix();
    const Vec3 corner = random_corner();
    const Vec3 place = corner + random_.in_cube(0.01 * model_.diagonal_m);
    pose.translation_m = moment_.goal_m - pose.scale * (pose.rotation * place);
}

WanderingOperator::WanderingOperator(const TestModel& model, Random& random)
    : tree_(model.faces), motion_(model, tree_, 0.01 * model.diagonal_m, 1.0, random)
{
}

Vec3 WanderingOperator::next()
{
    const Moment moment = motion_.next();
    return to_model(moment.pose, moment.goal_m);
}

} // namespace tactus::test
