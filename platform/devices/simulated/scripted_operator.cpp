// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/simulated/scripted_operator.hpp"

#include "platform/devices/simulated/motion_maths.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus
{

namespace
{

/// Distance from the aim, in diagonals, below which the approach keeps its direction: at the aim
/// itself the direction would swing around.
constexpr double kSteerUntilDiag = 0.05;
/// Mean speed of the flight, including start and end, as a share of its largest speed.
constexpr double kMeanSpeedShare = 0.8;
constexpr double kGateReachedDiag = 0.02;
/// Part of the way to the gate across the outward direction, in distances from the centre, up to
/// which the gate lies opposite.
constexpr double kOppositeShare = 1e-3;
/// Distance past the aim, in diagonals, at which a site is given up.
constexpr double kApproachBeyondDiag = 0.5;
constexpr double kLiftRadii = 3.0;
constexpr double kSlowDownRadii = 2.0;
/// Distance past the last place at which a descent has failed: in tool radii, and in m for the dent
/// of the pressing.
constexpr double kDescendBeyondRadii = 4.0;
constexpr double kDescendBeyondM = 0.005;
/// Share of a distance that is corrected per second.
constexpr double kClimbPerS = 20.0;

/// Largest deflection of the hand's spring in contact: at 200 N/m, 4 N.
constexpr double kLeashM = 0.02;
constexpr double kLostAfterS = 0.05;
/// Duration of a force after which it is a contact: no fade of a force lasts longer (kFadeTime_s).
constexpr double kSureAfterS = 0.05;
constexpr double kGoodContactS = 0.5;
constexpr std::uint32_t kLossesBeforeBackOff = 4;
constexpr double kSettleBeforeLiftS = 0.1;
constexpr double kPatienceS = 1.0;
constexpr double kPlaceSpacingS = 0.064;

/// Point on the orbit from which a path of about `way_m` leads to the gate. The rotation is given
/// by the tangent of half its angle, so it needs no trigonometry.
Vec3 orbit_start(const LandingSite& site, const Vec3& centre, double way_m) noexcept
{
    const double half_tangent = std::min(0.5 * way_m / site.orbit_radius_m, 1.2);
    const double square = half_tangent * half_tangent;
    const Vec3 to_gate = (site.gate_world_m - centre) / site.orbit_radius_m;
    const Vec3 back = any_across(to_gate) * (2.0 * half_tangent) + to_gate * (1.0 - square);
    return centre + back * (site.orbit_radius_m / (1.0 + square));
}

/// Fault of the scene; empty if it can be played.
std::string find_fault(const OperatorScene& scene)
{
    if (scene.anchors_world_m.empty())
    {
        return "simulated operator: the model has no anchor points to touch";
    }
    const auto finite = [](const Vec3& point) { return std::isfinite(point.squaredNorm()); };
    if (!std::ranges::all_of(scene.anchors_world_m, finite))
    {
        return "simulated operator: an anchor point is not finite";
    }
    if (!std::isfinite(scene.diagonal_m) || scene.diagonal_m <= 0.0)
    {
        return "simulated operator: the model's diagonal must be finite and above 0 m";
    }
    if (!std::isfinite(scene.tool_radius_m) || scene.tool_radius_m <= 0.0 ||
        scene.tool_radius_m > scene.diagonal_m)
    {
        return "simulated operator: tool radius " + std::to_string(scene.tool_radius_m) +
               " m is out of range (0, " + std::to_string(scene.diagonal_m) +
               "] m (the model's diagonal)";
    }
    if (scene.period <= Duration{})
    {
        return "simulated operator: the period must be above 0 ns";
    }
    return {};
}

} // namespace

Result<std::unique_ptr<ScriptedOperator>, Refusal>
ScriptedOperator::create(const OperatorScene& scene)
{
    if (std::string fault = find_fault(scene); !fault.empty())
    {
        return Refusal{std::move(fault)};
    }
    return std::unique_ptr<ScriptedOperator>(new ScriptedOperator(scene));
}

ScriptedOperator::ScriptedOperator(const OperatorScene& scene)
    : diagonal_m_(scene.diagonal_m)
    , tool_radius_m_(scene.tool_radius_m)
    , period_s_(to_seconds(scene.period))
    , pace_(diagonal_m_)
    , schedule_(static_cast<double>(scene.frames_total) * period_s_, period_s_, scene.lifts_off)
    , place_spacing_frames_(OperatorSchedule::frames_in(kPlaceSpacingS, period_s_) + 1)
    , centre_world_m_(centre_of(scene.anchors_world_m))
    , sites_(find_landing_sites(scene.anchors_world_m, diagonal_m_, tool_radius_m_,
                                scene.operators_before))
    , start_world_m_(orbit_start(sites_.front(), centre_world_m_,
                                 kMeanSpeedShare * pace_.flight_m_per_s * schedule_.flight_s))
    , position_world_m_(start_world_m_)
    , slide_(diagonal_m_, period_s_)
{
}

double ScriptedOperator::reach_m() const noexcept
{
    double orbit_m = 0.0;
    for (const LandingSite& each : sites_)
    {
        orbit_m = std::max(orbit_m, each.orbit_radius_m);
    }
    return orbit_m + diagonal_m_;
}

Vec3 ScriptedOperator::next_world_m(const OperatorSense& sense) noexcept
{
    ++frames_in_phase_;
    update_touch(sense);
    if (sense.frame >= schedule_.retreat_frame && phase_ != OperatorPhase::retreat)
    {
        enter(OperatorPhase::retreat);
    }
    move_towards(target(sense));
    if (slide_.is_touching(sense) || phase_ == OperatorPhase::slide)
    {
        stay_near_device(sense);
    }
    return position_world_m_;
}

Vec3 ScriptedOperator::target(const OperatorSense& sense) noexcept
{
    switch (phase_)
    {
    case OperatorPhase::flight:
        return fly();
    case OperatorPhase::approach:
        return approach(sense);
    case OperatorPhase::slide:
        return slide(sense);
    case OperatorPhase::lift:
        return lift(sense);
    case OperatorPhase::come_back:
        return come_back();
    case OperatorPhase::descend:
        return descend(sense);
    case OperatorPhase::back_off:
        return back_off();
    case OperatorPhase::retreat:
        break;
    }
    return retreat();
}

Vec3 ScriptedOperator::fly() noexcept
{
    const Vec3 from_centre = position_world_m_ - centre_world_m_;
    const double radius_m = from_centre.norm();
    const Vec3 outward = direction_or_zero(from_centre);
    const Vec3 to_gate = site().gate_world_m - position_world_m_;
    if (to_gate.norm() < kGateReachedDiag * diagonal_m_)
    {
        approach_direction_ = direction_or_zero(site().aim_world_m - position_world_m_);
        enter(OperatorPhase::approach);
    }
    const Vec3 along = part_across(to_gate, outward);
    // Opposite to the gate all directions are equally long.
    const bool opposite = along.norm() < kOppositeShare * radius_m && to_gate.dot(outward) < 0.0;
    const Vec3 tangent = opposite ? any_across(outward) : direction_or_zero(along);
    const double climb = kClimbPerS * (site().orbit_radius_m - radius_m);
    const double speed = pace_.flight_m_per_s;
    return tangent * pace_.stoppable(speed, to_gate.norm()) +
           outward * std::clamp(climb, -speed, speed);
}

Vec3 ScriptedOperator::approach(const OperatorSense& sense) noexcept
{
    if (meets(sense, approach_direction_))
    {
        land(sense, centre_world_m_ - position_world_m_);
        return Vec3::Zero();
    }
    const Vec3 to_aim = site().aim_world_m - position_world_m_;
    if (to_aim.norm() > kSteerUntilDiag * diagonal_m_ && to_aim.dot(approach_direction_) > 0.0)
    {
        approach_direction_ = direction_or_zero(to_aim);
    }
    const double left_m = to_aim.dot(approach_direction_);
    if (left_m < -kApproachBeyondDiag * diagonal_m_)
    {
        enter(OperatorPhase::back_off);
    }
    const double gap_m = left_m - tool_radius_m_;
    return approach_direction_ *
           pace_.slowing(pace_.approach_m_per_s, gap_m, OperatorPace::kSlowDown_diag * diagonal_m_);
}

Vec3 ScriptedOperator::slide(const OperatorSense& sense) noexcept
{
    const Vec3 velocity = slide_.next_velocity(sense);
    if (slide_.untouched_s() > kLostAfterS)
    {
        lose_contact();
    }
    else if (is_landing_sure_ && slide_.is_touching(sense))
    {
        remember_place(sense);
        losses_ = seconds_in_phase() > kGoodContactS ? 0 : losses_;
        if (seconds_in_phase() >= kSettleBeforeLiftS &&
            schedule_.lift_is_due(sense.frame, lift_offs_))
        {
            place_ = place_here(sense);
            released_ = false;
            enter(OperatorPhase::lift);
        }
    }
    return velocity;
}

/// Ends a slide that has lost contact. Returns to the last place of contact and continues in the
/// other direction; after repeated failures, goes to another site. After a false touch it resumes
/// the phase before.
void ScriptedOperator::lose_contact() noexcept
{
    ++losses_;
    if (is_landing_sure_)
    {
        place_.heading = -place_.heading;
    }
    const OperatorPhase again = is_landing_sure_ ? OperatorPhase::come_back : landed_from_;
    enter(losses_ < kLossesBeforeBackOff ? again : OperatorPhase::back_off);
}

Vec3 ScriptedOperator::lift(const OperatorSense& sense) noexcept
{
    if (!released_ && !slide_.is_touching(sense))
    {
        released_ = true;
        released_world_m_ = sense.device_world_m;
    }
    const double height_m = kLiftRadii * tool_radius_m_;
    const double risen_m =
        released_ ? (sense.device_world_m - released_world_m_).dot(place_.normal) : 0.0;
    if (risen_m >= height_m)
    {
        ++lift_offs_;
        enter(OperatorPhase::descend);
    }
    else if (seconds_in_phase() > kPatienceS)
    {
        enter(OperatorPhase::descend);
    }
    // The target is half a radius higher than needed; otherwise the hand would creep to the height.
    const double left_m = height_m - risen_m + 0.5 * tool_radius_m_;
    return place_.normal * pace_.stoppable(pace_.lift_m_per_s, std::max(left_m, 0.0));
}

/// Rises to the height of a lift-off first, then moves across.
Vec3 ScriptedOperator::come_back() noexcept
{
    const double height_m = kLiftRadii * tool_radius_m_;
    const Vec3 to_place = place_.point_world_m - position_world_m_;
    const double rise_m = to_place.dot(place_.normal) + height_m;
    const Vec3 across = part_across(to_place, place_.normal);
    if (across.norm() < tool_radius_m_)
    {
        enter(OperatorPhase::descend);
    }
    else if (seconds_in_phase() > kPatienceS)
    {
        enter(OperatorPhase::back_off);
    }
    const double speed = pace_.lift_m_per_s;
    const double up = std::clamp(kClimbPerS * rise_m, -speed, speed);
    const double share = OperatorPace::smoothstep(1.0 - rise_m / height_m);
    return place_.normal * up +
           direction_or_zero(across) * (share * pace_.stoppable(speed, across.norm()));
}

Vec3 ScriptedOperator::descend(const OperatorSense& sense) noexcept
{
    if (meets(sense, -place_.normal))
    {
        land(sense, place_.heading);
        return Vec3::Zero();
    }
    const Vec3 to_place = place_.point_world_m - position_world_m_;
    const double height_m = -to_place.dot(place_.normal);
    if (height_m < -(kDescendBeyondRadii * tool_radius_m_ + kDescendBeyondM))
    {
        enter(OperatorPhase::back_off);
    }
    const double speed =
        pace_.slowing(pace_.lift_m_per_s, height_m, kSlowDownRadii * tool_radius_m_);
    return part_across(to_place, place_.normal) * kClimbPerS - place_.normal * speed;
}

Vec3 ScriptedOperator::back_off() noexcept
{
    const Vec3 to_gate = site().gate_world_m - position_world_m_;
    if (to_gate.norm() < kGateReachedDiag * diagonal_m_ || seconds_in_phase() > kPatienceS)
    {
        site_ = (site_ + 1) % sites_.size();
        losses_ = 0;
        enter(OperatorPhase::flight);
    }
    return direction_or_zero(to_gate) * pace_.stoppable(pace_.approach_m_per_s, to_gate.norm());
}

Vec3 ScriptedOperator::retreat() noexcept
{
    const Vec3 outward = direction_or_zero(position_world_m_ - centre_world_m_);
    return (landed_ ? slide_.normal() : outward) * pace_.retreat_m_per_s;
}

void ScriptedOperator::enter(OperatorPhase phase) noexcept
{
    phase_ = phase;
    frames_in_phase_ = 0;
    felt_s_ = 0.0;
}

void ScriptedOperator::update_touch(const OperatorSense& sense) noexcept
{
    felt_s_ = slide_.is_touching(sense) ? felt_s_ + period_s_ : 0.0;
    if (phase_ == OperatorPhase::slide && !is_landing_sure_ && slide_.touched_s() >= kSureAfterS)
    {
        is_landing_sure_ = true;
        place_ = place_here(sense);
        newest_place_ = place_;
    }
}

/// True at a touch: a surface pushes against the motion, and its force is firm or lasts. A force
/// alone is no touch, since a force that fades after a fault damps the motion a little, in the air,
/// too.
bool ScriptedOperator::meets(const OperatorSense& sense, const Vec3& way) const noexcept
{
    return slide_.is_touching(sense) && sense.force_world_n.dot(way) < 0.0 &&
           (slide_.is_firm(sense) || felt_s_ >= kSureAfterS);
}

/// Starts a slide. place_ keeps the last place of contact until this touch is sure.
void ScriptedOperator::land(const OperatorSense& sense, const Vec3& heading_hint) noexcept
{
    slide_.begin(sense, heading_hint);
    landed_ = true;
    landed_from_ = phase_;
    is_landing_sure_ = false;
    enter(OperatorPhase::slide);
}

void ScriptedOperator::remember_place(const OperatorSense& sense) noexcept
{
    if (frames_in_phase_ % place_spacing_frames_ == 0)
    {
        place_ = newest_place_;
        newest_place_ = place_here(sense);
    }
}

ScriptedOperator::Place ScriptedOperator::place_here(const OperatorSense& sense) const noexcept
{
    return {sense.device_world_m, slide_.normal(), slide_.heading()};
}

void ScriptedOperator::move_towards(const Vec3& commanded_m_per_s) noexcept
{
    const Vec3 change = commanded_m_per_s - velocity_m_per_s_;
    const double allowed = pace_.acceleration_m_per_s2 * period_s_;
    const double length = change.norm();
    velocity_m_per_s_ += length > allowed ? Vec3(change * (allowed / length)) : change;
    position_world_m_ += velocity_m_per_s_ * period_s_;
}

void ScriptedOperator::stay_near_device(const OperatorSense& sense) noexcept
{
    const Vec3 ahead = position_world_m_ - sense.device_world_m;
    const double length = ahead.norm();
    if (length > kLeashM)
    {
        position_world_m_ = sense.device_world_m + ahead * (kLeashM / length);
    }
}

double ScriptedOperator::seconds_in_phase() const noexcept
{
    return static_cast<double>(frames_in_phase_) * period_s_;
}

} // namespace tactus
