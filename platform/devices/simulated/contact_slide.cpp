// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/simulated/contact_slide.hpp"

#include "platform/devices/simulated/motion_maths.hpp"
#include "rt_core/base/assert.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

constexpr double kSlideSpeedDiagPerS = 0.1;
/// Set force. On a wall of 500 N/m and a hand of 200 N/m, 1 N puts the hand 7 mm deep; small models
/// are touched more lightly so that the hand stays within 3.5 % of a diagonal.
constexpr double kForceN = 1.0;
constexpr double kForceNPerDiagonalM = 5.0;
/// Variation of the set force, as a fraction, as in a person's hand.
constexpr double kSwing = 0.3;
constexpr double kSwingPeriodS = 1.6;
/// Gain of the pressing. With 140 to 190 N/m between hand and wall the force follows at about 25
/// rad/s, well below the 80 rad/s at which device and wall oscillate.
constexpr double kPressGainMPerNs = 0.175;
constexpr double kPressSpeedMaxMPerS = 0.1;
constexpr double kPressSpeedMaxDiagPerS = 0.5;
/// Rate at which the heading turns: circles with a radius of an eighth of a diagonal.
constexpr double kTurnRadPerS = 0.8;
constexpr double kNormalFilterS = 0.005;
constexpr double kSpeedFilterS = 0.02;
constexpr double kSpeedGainPerS = 10.0;
constexpr double kSpeedFactorMin = 0.3;
constexpr double kSpeedFactorMax = 1.5;
/// A device slower than this share of the set speed, for this long, has met an obstacle.
constexpr double kStuckShare = 0.3;
constexpr double kStuckAfterS = 0.2;
/// Share of the set force below which a force counts as no contact.
constexpr double kFeltShare = 0.02;
/// Share of the set force above which a contact is firm. A fading force damps with half of the
/// device's own damping at most. With 1 N s/m that is 0.16 N during the approach to the default
/// model.
constexpr double kFirmShare = 0.2;

/// Share of the new value in a first-order low-pass.
double filter_share(double period_s, double time_s) noexcept
{
    return period_s / (period_s + time_s);
}

/// Unit vector perpendicular to `normal`, along the part of `heading` there; any such vector if
/// `heading` is parallel to `normal`.
Vec3 heading_across(const Vec3& normal, const Vec3& heading) noexcept
{
    constexpr double kParallel = 1e-6;
    const Vec3 across = part_across(heading, normal);
    const double length = across.norm();
    return length > kParallel * heading.norm() ? Vec3(across / length) : any_across(normal);
}

} // namespace

ContactSlide::ContactSlide(double diagonal_m, double period_s) noexcept
    : period_s_(period_s)
    , speed_m_per_s_(kSlideSpeedDiagPerS * diagonal_m)
    , force_n_(std::min(kForceN, kForceNPerDiagonalM * diagonal_m))
    , press_speed_max_m_per_s_(std::min(kPressSpeedMaxMPerS, kPressSpeedMaxDiagPerS * diagonal_m))
{
}

void ContactSlide::begin(const OperatorSense& sense, const Vec3& heading_hint) noexcept
{
    TACTUS_ASSERT(is_touching(sense));
    normal_ = sense.force_world_n.normalized();
    heading_ = heading_across(normal_, heading_hint);
    last_device_world_m_ = sense.device_world_m;
    device_speed_m_per_s_ = speed_m_per_s_;
    speed_factor_ = 1.0;
    untouched_s_ = 0.0;
    touched_s_ = 0.0;
    stuck_s_ = 0.0;
}

Vec3 ContactSlide::next_velocity(const OperatorSense& sense) noexcept
{
    ++frames_;
    const double force_n = sense.force_world_n.norm();
    follow_surface(sense, force_n);
    correct_speed(sense);
    turn_round_when_stuck();
    return heading_ * (speed_m_per_s_ * speed_factor_) + press(force_n);
}

void ContactSlide::turn_round() noexcept
{
    heading_ = -heading_;
    device_speed_m_per_s_ = speed_m_per_s_;
    speed_factor_ = 1.0;
    stuck_s_ = 0.0;
}

bool ContactSlide::is_touching(const OperatorSense& sense) const noexcept
{
    return sense.force_world_n.norm() > kFeltShare * force_n_;
}

bool ContactSlide::is_firm(const OperatorSense& sense) const noexcept
{
    return sense.force_world_n.norm() > kFirmShare * force_n_;
}

/// Wanted force in this frame: a triangle wave with rounded corners around the set force.
double ContactSlide::wanted_force_n() const noexcept
{
    const double turns = static_cast<double>(frames_) * period_s_ / kSwingPeriodS;
    const double phase = turns - static_cast<double>(static_cast<std::int64_t>(turns));
    const double ramp = phase < 0.5 ? 2.0 * phase : 2.0 - 2.0 * phase;
    const double smooth = ramp * ramp * (3.0 - 2.0 * ramp);
    return force_n_ * (1.0 + kSwing * (2.0 * smooth - 1.0));
}

Vec3 ContactSlide::press(double force_n) const noexcept
{
    const double speed = kPressGainMPerNs * (wanted_force_n() - force_n);
    return -normal_ * std::clamp(speed, -press_speed_max_m_per_s_, press_speed_max_m_per_s_);
}

/// Moves the normal towards the felt force. Turns the heading slowly about the normal, then into
/// the surface.
void ContactSlide::follow_surface(const OperatorSense& sense, double force_n) noexcept
{
    if (!is_touching(sense))
    {
        untouched_s_ += period_s_;
        touched_s_ = 0.0;
        return;
    }
    untouched_s_ = 0.0;
    touched_s_ += period_s_;
    const Vec3 felt = sense.force_world_n / force_n;
    const Vec3 blend = normal_ + (felt - normal_) * filter_share(period_s_, kNormalFilterS);
    // Opposite normals, as at the rim of a sheet, cancel out: then the new one is used.
    normal_ = blend.norm() > 0.1 ? Vec3(blend.normalized()) : felt;
    const Vec3 turned = heading_ + normal_.cross(heading_) * (kTurnRadPerS * period_s_);
    heading_ = heading_across(normal_, turned);
}

void ContactSlide::correct_speed(const OperatorSense& sense) noexcept
{
    const Vec3 moved_m = sense.device_world_m - last_device_world_m_;
    last_device_world_m_ = sense.device_world_m;
    const double speed = moved_m.dot(heading_) / period_s_;
    device_speed_m_per_s_ +=
        (speed - device_speed_m_per_s_) * filter_share(period_s_, kSpeedFilterS);
    const double missing = 1.0 - device_speed_m_per_s_ / speed_m_per_s_;
    speed_factor_ = std::clamp(speed_factor_ + kSpeedGainPerS * period_s_ * missing,
                               kSpeedFactorMin, kSpeedFactorMax);
}

void ContactSlide::turn_round_when_stuck() noexcept
{
    const bool slow = device_speed_m_per_s_ < kStuckShare * speed_m_per_s_;
    stuck_s_ = slow ? stuck_s_ + period_s_ : 0.0;
    if (stuck_s_ > kStuckAfterS)
    {
        turn_round();
    }
}

} // namespace tactus
