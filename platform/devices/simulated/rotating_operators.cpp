// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/simulated/rotating_operators.hpp"

#include "platform/devices/simulated/landing_sites.hpp"
#include "platform/devices/simulated/operator_pace.hpp"

#include <algorithm>
#include <utility>

namespace tactus
{

namespace
{

/// Tangents of half the largest angles: 30 and 2 degrees.
constexpr double kTurnHalfTangent = 0.2679;
constexpr double kTiltHalfTangent = 0.01746;
constexpr double kSwingsPerSecond = 0.5;
constexpr double kTurnPressTime_s = 0.3;

/// Time in which the assumed surface normal follows the felt force, and the largest speed of the
/// wrist.
constexpr double kNormalTime_s = 0.02;
constexpr double kTurnMax_rad_per_s = 4.0;

/// Start height above the model, in tool radii: the tool extends up to twice that radius.
constexpr double kPegClearRadii = 2.2;
constexpr double kPegClear_diag = 0.05;
constexpr double kPegSpeed_diag_per_s = 0.5;
constexpr double kPegSpeedMax_m_per_s = 0.3;
/// Same forces as in ContactSlide.
constexpr double kPress_n = 1.0;
constexpr double kPress_n_per_diagonal_m = 5.0;
constexpr double kPressed_s = 0.02;
constexpr double kTilt_s = 4.0; ///< Time of two swings, one about each axis.
constexpr double kOut_s = 0.5;
constexpr double kOut_diag = 1.0 / 6.0;
constexpr double kChangeGrip_s = 0.6;
constexpr double kChangeGrip_diag = 0.03;
constexpr double kGripperHeld_m = 0.02;
constexpr double kGripperOpen_m = 0.05;

double highest_m(const OperatorScene& scene) noexcept
{
    return std::ranges::max_element(scene.anchors_world_m, {}, [](const Vec3& p) { return p.z(); })
        ->z();
}

/// Smooth function of a phase's elapsed share: 0 at both ends, 1 in the middle.
double there_and_back(double share) noexcept
{
    return OperatorPace::smoothstep(2.0 * std::min(share, 1.0 - share));
}

} // namespace

RotatingOperator::RotatingOperator(const OperatorScene& scene)
    : LandedOperator(scene)
    , swings_(kTurnHalfTangent, kSwingsPerSecond, 3, to_seconds(scene.period))
{
}

OperatorGrip RotatingOperator::grip() const noexcept
{
    OperatorGrip grip;
    grip.rotation = swings_.rotation();
    return grip;
}

Vec3 RotatingOperator::offset_m(double seconds) noexcept
{
    swings_.step();
    return {0.0, 0.0, press_m() * OperatorPace::smoothstep(seconds / kTurnPressTime_s)};
}

EdgeOperator::EdgeOperator(std::unique_ptr<OperatorMotion> way, const OperatorScene& scene)
    : way_(std::move(way))
    , feeling_(scene.diagonal_m, to_seconds(scene.period))
    , period_s_(to_seconds(scene.period))
{
}

OperatorGrip EdgeOperator::grip() const noexcept
{
    OperatorGrip grip = way_->grip();
    grip.rotation = rotation_;
    return grip;
}

Vec3 EdgeOperator::next_world_m(const OperatorSense& sense) noexcept
{
    if (feeling_.is_touching(sense))
    {
        turn_with(sense.force_world_n.normalized());
    }
    return way_->next_world_m(sense);
}

/// Rotates the tool as the felt normal rotates, no faster than the wrist; the rest follows in later
/// frames.
void EdgeOperator::turn_with(const Vec3& felt) noexcept
{
    if (!has_touched_)
    {
        has_touched_ = true;
        normal_ = felt;
    }
    Vec3 turn = normal_.cross(felt) * (period_s_ / (period_s_ + kNormalTime_s));
    const double most = kTurnMax_rad_per_s * period_s_;
    turn *= most / std::max(turn.norm(), most);
    rotation_ = turned_exactly_by(turn, rotation_);
    normal_ = (normal_ + turn.cross(normal_)).normalized();
}

PegOperator::PegOperator(const OperatorScene& scene)
    : period_s_(to_seconds(scene.period))
    , diagonal_m_(scene.diagonal_m)
    , press_n_(std::min(kPress_n, kPress_n_per_diagonal_m * scene.diagonal_m))
    , speed_m_per_s_(std::min(kPegSpeed_diag_per_s * scene.diagonal_m, kPegSpeedMax_m_per_s))
    , start_world_m_(centre_of(scene.anchors_world_m))
    , swings_(kTiltHalfTangent, kSwingsPerSecond, 2, period_s_)
{
    const double middle_m = start_world_m_.z();
    start_world_m_.z() =
        highest_m(scene) + kPegClearRadii * scene.tool_radius_m + kPegClear_diag * scene.diagonal_m;
    way_max_m_ = start_world_m_.z() - middle_m + 0.5 * scene.diagonal_m;
}

Vec3 PegOperator::next_world_m(const OperatorSense& sense) noexcept
{
    in_phase_s_ += period_s_;
    double lifted_m = 0.0;
    switch (phase_)
    {
    case Phase::in:
        go_in(sense);
        break;
    case Phase::tilt:
        swings_.step();
        if (is_over(kTilt_s))
        {
            deepest_m_ = way_m_;
            enter(Phase::out);
        }
        break;
    case Phase::out:
        way_m_ =
            deepest_m_ - kOut_diag * diagonal_m_ * OperatorPace::smoothstep(in_phase_s_ / kOut_s);
        if (is_over(kOut_s))
        {
            enter(Phase::change_grip);
        }
        break;
    case Phase::change_grip:
        lifted_m = kChangeGrip_diag * diagonal_m_ * there_and_back(in_phase_s_ / kChangeGrip_s);
        if (is_over(kChangeGrip_s))
        {
            enter(Phase::in);
        }
        break;
    }
    return start_world_m_ + Vec3::UnitZ() * (lifted_m - way_m_);
}

/// Descends until pressed for a moment, or until the path ends.
void PegOperator::go_in(const OperatorSense& sense) noexcept
{
    const bool is_pressed = sense.force_world_n.z() >= press_n_;
    pressed_s_ = is_pressed ? pressed_s_ + period_s_ : 0.0;
    if (pressed_s_ >= kPressed_s || way_m_ >= way_max_m_)
    {
        enter(Phase::tilt);
    }
    else if (!is_pressed)
    {
        way_m_ += speed_m_per_s_ * period_s_;
    }
}

OperatorGrip PegOperator::grip() const noexcept
{
    OperatorGrip grip;
    grip.rotation = swings_.rotation();
    grip.gripper_m = kGripperHeld_m;
    if (phase_ == Phase::change_grip)
    {
        grip.buttons = 1U;
        *grip.gripper_m +=
            (kGripperOpen_m - kGripperHeld_m) * there_and_back(in_phase_s_ / kChangeGrip_s);
    }
    return grip;
}

void PegOperator::enter(Phase phase) noexcept
{
    phase_ = phase;
    in_phase_s_ = 0.0;
    pressed_s_ = 0.0;
}

bool PegOperator::is_over(double seconds) const noexcept
{
    return in_phase_s_ >= seconds;
}

} // namespace tactus
