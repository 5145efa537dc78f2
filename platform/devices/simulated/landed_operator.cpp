// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/simulated/landed_operator.hpp"

#include "platform/devices/simulated/landing_sites.hpp"
#include "platform/devices/simulated/motion_maths.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

constexpr double kBeyondDiag = 0.5;
constexpr double kSpeedFilter_s = 0.01;
/// Share of the hand's speed below which the device is in contact: in the air the device is as fast
/// as the hand, on a wall of 500 N/m a third of that.
constexpr double kDataLimitedShare = 0.6;
constexpr double kPress_m = 0.0075;
constexpr double kPressDiag = 0.035;
constexpr double kPressTime_s = 0.3;
constexpr double kTapsPerSecond = 2.0;
constexpr double kTapRadii = 3.0;
constexpr double kSpinsPerSecond = 2.0;
constexpr double kSpinRadiusDiag = 0.05;

} // namespace

LandedOperator::LandedOperator(const OperatorScene& scene)
    : period_s_(to_seconds(scene.period))
    , diagonal_m_(scene.diagonal_m)
    , tool_radius_m_(scene.tool_radius_m)
    , press_m_(std::min(kPress_m, kPressDiag * scene.diagonal_m))
    , pace_(scene.diagonal_m)
    , feeling_(scene.diagonal_m, period_s_)
{
    const std::vector<LandingSite> sites = find_landing_sites(
        scene.anchors_world_m, diagonal_m_, tool_radius_m_, scene.operators_before);
    const Vec3 way_m = sites.front().aim_world_m - sites.front().gate_world_m;
    start_world_m_ = sites.front().gate_world_m;
    last_device_world_m_ = start_world_m_;
    length_m_ = way_m.norm();
    down_ = way_m / length_m_;
    across_ = any_across(down_);
}

Vec3 LandedOperator::next_world_m(const OperatorSense& sense) noexcept
{
    if (has_landed_)
    {
        const Vec3 offset = offset_m(static_cast<double>(++frames_since_) * period_s_);
        return touched_world_m_ + across_ * offset.x() + down_.cross(across_) * offset.y() +
               down_ * offset.z();
    }
    const double left_m = length_m_ - way_m_ - tool_radius_m_;
    const double speed =
        pace_.slowing(pace_.approach_m_per_s, left_m, OperatorPace::kSlowDown_diag * diagonal_m_);
    way_m_ = std::min(way_m_ + speed * period_s_, length_m_ + kBeyondDiag * diagonal_m_);
    touched_world_m_ = start_world_m_ + down_ * way_m_;
    has_landed_ = has_met_something(sense, left_m, speed);
    return touched_world_m_;
}

/// True at a touch: near the surface, with a force and a slowed device. A force alone is no touch:
/// a force that returns after a fault damps the motion, in the air, too.
bool LandedOperator::has_met_something(const OperatorSense& sense, double left_m,
                                       double speed_m_per_s) noexcept
{
    const Vec3 moved_m = sense.device_world_m - last_device_world_m_;
    last_device_world_m_ = sense.device_world_m;
    device_speed_m_per_s_ += (moved_m.dot(down_) / period_s_ - device_speed_m_per_s_) * period_s_ /
                             (period_s_ + kSpeedFilter_s);
    return left_m < OperatorPace::kSlowDown_diag * diagonal_m_ && feeling_.is_touching(sense) &&
           device_speed_m_per_s_ < kDataLimitedShare * speed_m_per_s;
}

Vec3 PressingOperator::offset_m(double seconds) noexcept
{
    return {0.0, 0.0, press_m() * OperatorPace::smoothstep(seconds / kPressTime_s)};
}

TappingOperator::TappingOperator(const OperatorScene& scene)
    : LandedOperator(scene), height_m_(kTapRadii * scene.tool_radius_m)
{
}

Vec3 TappingOperator::offset_m(double seconds) noexcept
{
    const double taps = seconds * kTapsPerSecond;
    const double phase = taps - std::floor(taps);
    const double lifted = OperatorPace::smoothstep(phase < 0.5 ? 2.0 * phase : 2.0 - 2.0 * phase);
    const double pressed = OperatorPace::smoothstep(seconds / kPressTime_s);
    return {0.0, 0.0, press_m() * pressed - (press_m() + height_m_) * lifted};
}

SpinningOperator::SpinningOperator(const OperatorScene& scene)
    : LandedOperator(scene)
    , radius_m_(kSpinRadiusDiag * scene.diagonal_m)
    , phasor_(kSpinsPerSecond, to_seconds(scene.period))
{
}

Vec3 SpinningOperator::offset_m(double seconds) noexcept
{
    phasor_.turn();
    return {radius_m_ * (phasor_.cos() - 1.0), radius_m_ * phasor_.sin(),
            press_m() * OperatorPace::smoothstep(seconds / kPressTime_s)};
}

} // namespace tactus
