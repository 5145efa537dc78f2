// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/simulated/operator_and_device.hpp"

#include "rt_core/math/value_range.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace tactus
{

namespace
{

constexpr double kPeriodMin_s = 1e-5;
constexpr double kPeriodMax_s = 0.1;

bool is_usable(const DeviceLimits& device) noexcept
{
    return is_positive(device.mass_kg) && is_not_negative(device.damping_n_s_per_m) &&
           is_not_negative(device.friction_n) && is_not_negative(device.quantum_m) &&
           is_not_negative(device.delay_s) && is_positive(device.force_max_n) &&
           is_positive(device.slew_max_n_per_s) && is_positive(device.stiffness_max_n_per_m) &&
           is_not_negative(device.added_damping_max_n_s_per_m);
}

bool is_usable(const OperatorLimb& hand) noexcept
{
    return is_not_negative(hand.mass_kg) && is_not_negative(hand.stiffness_n_per_m) &&
           is_not_negative(hand.damping_n_s_per_m) &&
           is_not_negative(hand.grip_stiffness_n_per_m) &&
           is_not_negative(hand.grip_damping_n_s_per_m) &&
           hand.mass_kg + hand.stiffness_n_per_m + hand.damping_n_s_per_m > 0.0;
}

/// Fault of the options; empty if none.
std::string find_bad_option(const OperatorAndDeviceOptions& options)
{
    if (!is_usable(options.device))
    {
        return "simulated operator and device: the device's mass, largest force, slew and "
               "stiffness must be finite and above zero; its dampings, friction, quantum and delay "
               "must be finite and not negative";
    }
    if (!is_usable(options.hand))
    {
        return "simulated operator and device: the operator's values must be finite and not "
               "negative; mass, arm stiffness or arm damping must be above zero";
    }
    if (!(options.period_s >= kPeriodMin_s && options.period_s <= kPeriodMax_s))
    {
        return "simulated operator and device: period " + std::to_string(options.period_s) +
               " s is out of range 0.00001..0.1 s";
    }
    if (options.device.delay_s > OperatorAndDevice::kDelayMaxPeriods * options.period_s)
    {
        return "simulated operator and device: delay " + std::to_string(options.device.delay_s) +
               " s is longer than 8 periods";
    }
    const double from_centre_m = (options.start_world_m - options.workspace_centre_world_m).norm();
    if (!is_positive(options.workspace_radius_m) || !(from_centre_m <= options.workspace_radius_m))
    {
        return "simulated operator and device: the start is " + std::to_string(from_centre_m) +
               " m from the workspace centre; the workspace radius is " +
               std::to_string(options.workspace_radius_m) + " m";
    }
    return {};
}

/// Zero for a non-finite force, otherwise the force within the motors' limit.
Vec3 motor_force(const Vec3& force_n, double force_max_n) noexcept
{
    const double norm_n = force_n.norm();
    if (!std::isfinite(norm_n))
    {
        return Vec3::Zero();
    }
    return norm_n > force_max_n ? Vec3(force_n * (force_max_n / norm_n)) : force_n;
}

} // namespace

Result<OperatorAndDevice, Refusal>
OperatorAndDevice::create(const OperatorAndDeviceOptions& options)
{
    if (std::string wrong = find_bad_option(options); !wrong.empty())
    {
        return Refusal{std::move(wrong)};
    }
    return OperatorAndDevice(options);
}

OperatorAndDevice::OperatorAndDevice(const OperatorAndDeviceOptions& options) noexcept
    : options_(options)
    , dt_s_(options.period_s / kSubSteps)
    , delay_sub_steps_(static_cast<std::uint32_t>(std::lround(options.device.delay_s / dt_s_)))
    , device_m_(options.start_world_m)
    , hand_m_(options.start_world_m)
    , target_m_(options.start_world_m)
{
    forces_n_.fill(Vec3::Zero());
}

Vec3 OperatorAndDevice::step(const Vec3& force_n, const Vec3& target_m) noexcept
{
    std::shift_right(forces_n_.begin(), forces_n_.end(), 1);
    forces_n_[0] = motor_force(force_n, options_.device.force_max_n);
    const Vec3 target_velocity = (target_m - target_m_) / options_.period_s;
    for (std::uint32_t i = 0; i < kSubSteps; ++i)
    {
        const Vec3 target_mid_m = target_m_ + target_velocity * (dt_s_ * (i + 0.5));
        sub_step(force_at(i), target_mid_m, target_velocity);
    }
    target_m_ = target_m;
    return measured_m();
}

void OperatorAndDevice::brake(double damping_n_s_per_m) noexcept
{
    forces_n_.fill(Vec3::Zero());
    brake_n_s_per_m_ = damping_n_s_per_m;
}

const Vec3& OperatorAndDevice::force_at(std::uint32_t sub_step) const noexcept
{
    const std::uint32_t late = sub_step >= delay_sub_steps_
                                   ? 0
                                   : (delay_sub_steps_ - sub_step + kSubSteps - 1) / kSubSteps;
    return forces_n_[late];
}

/// Step of the implicit midpoint rule, from position x and velocity v to the velocity w midway. The
/// sum of all forces at x + w dt / 2 and w must equal 2 m (w - v) / dt. Two masses give two
/// equations on each axis.
OperatorAndDevice::Midway OperatorAndDevice::solve(const Vec3& force_n, const Vec3& target_mid_m,
                                                   const Vec3& target_velocity) const noexcept
{
    const DeviceLimits& device = options_.device;
    const OperatorLimb& hand = options_.hand;
    const double grip = 0.5 * dt_s_ * hand.grip_stiffness_n_per_m + hand.grip_damping_n_s_per_m;
    const double arm = 0.5 * dt_s_ * hand.stiffness_n_per_m + hand.damping_n_s_per_m;
    const double device_inertia = 2.0 * device.mass_kg / dt_s_;
    const double hand_inertia = 2.0 * hand.mass_kg / dt_s_;
    const double a11 = device_inertia + device.damping_n_s_per_m + brake_n_s_per_m_ + grip;
    const double a22 = hand_inertia + arm + grip;
    const Vec3 grip_n = (hand_m_ - device_m_) * hand.grip_stiffness_n_per_m;
    const Vec3 on_device = device_m_per_s_ * device_inertia + force_n + grip_n;
    const Vec3 on_hand = hand_m_per_s_ * hand_inertia - grip_n +
                         (target_mid_m - hand_m_) * hand.stiffness_n_per_m +
                         target_velocity * hand.damping_n_s_per_m;
    const double speed = device_m_per_s_.norm();
    Vec3 friction_n = Vec3::Zero();
    if (speed > 0.0)
    {
        friction_n = device_m_per_s_ * (-device.friction_n / speed);
    }
    else
    {
        const Vec3 hand_alone = on_hand / a22;
        const Vec3 pull_n = on_device + hand_alone * grip;
        const double pull = pull_n.norm();
        if (pull <= device.friction_n)
        {
            return {Vec3::Zero(), hand_alone, -pull_n};
        }
        friction_n = pull_n * (-device.friction_n / pull);
    }
    const double determinant = a11 * a22 - grip * grip;
    const Vec3 moved = on_device + friction_n;
    return {(moved * a22 + on_hand * grip) / determinant,
            (on_hand * a11 + moved * grip) / determinant, friction_n};
}

void OperatorAndDevice::sub_step(const Vec3& force_n, const Vec3& target_mid_m,
                                 const Vec3& target_velocity) noexcept
{
    const OperatorLimb& hand = options_.hand;
    Midway mid = solve(force_n, target_mid_m, target_velocity);
    Vec3 velocity = mid.device_m_per_s * 2.0 - device_m_per_s_;
    // Friction can only stop the motion in this step; the next step decides if it holds.
    const bool stops = options_.device.friction_n > 0.0 && velocity.dot(device_m_per_s_) < 0.0;
    if (stops)
    {
        velocity.setZero();
        mid.device_m_per_s = device_m_per_s_ * 0.5;
    }
    const Vec3 way = mid.device_m_per_s * dt_s_;
    const Vec3 grip_speed = mid.device_m_per_s - mid.hand_m_per_s;
    const Vec3 arm_speed = mid.hand_m_per_s - target_velocity;
    const Vec3 arm_n =
        (target_mid_m - hand_m_ - mid.hand_m_per_s * (0.5 * dt_s_)) * hand.stiffness_n_per_m -
        arm_speed * hand.damping_n_s_per_m;
    energy_.force_work_j += force_n.dot(way);
    energy_.target_work_j += arm_n.dot(target_velocity) * dt_s_;
    energy_.viscous_loss_j +=
        (options_.device.damping_n_s_per_m + brake_n_s_per_m_) * way.dot(mid.device_m_per_s);
    energy_.friction_loss_j -= mid.friction_n.dot(way);
    energy_.hand_loss_j += (hand.grip_damping_n_s_per_m * grip_speed.squaredNorm() +
                            hand.damping_n_s_per_m * arm_speed.squaredNorm()) *
                           dt_s_;
    device_m_ += way;
    device_m_per_s_ = velocity;
    hand_m_ += mid.hand_m_per_s * dt_s_;
    hand_m_per_s_ = mid.hand_m_per_s * 2.0 - hand_m_per_s_;
    stay_in_workspace();
}

/// Stops the device at the workspace's end without bounce: the outward velocity is lost.
void OperatorAndDevice::stay_in_workspace() noexcept
{
    const Vec3 from_centre_m = device_m_ - options_.workspace_centre_world_m;
    const double distance_m = from_centre_m.norm();
    if (distance_m <= options_.workspace_radius_m)
    {
        return;
    }
    const double before_j = stored_j();
    const Vec3 outward = from_centre_m / distance_m;
    device_m_ = options_.workspace_centre_world_m + outward * options_.workspace_radius_m;
    const double speed_out = std::max(0.0, device_m_per_s_.dot(outward));
    device_m_per_s_ -= outward * speed_out;
    energy_.stop_loss_j += before_j - stored_j();
}

Vec3 OperatorAndDevice::measured_m() const noexcept
{
    const double quantum = options_.device.quantum_m;
    if (!(quantum > 0.0))
    {
        return device_m_;
    }
    return {std::floor(device_m_.x() / quantum + 0.5) * quantum,
            std::floor(device_m_.y() / quantum + 0.5) * quantum,
            std::floor(device_m_.z() / quantum + 0.5) * quantum};
}

double OperatorAndDevice::stored_j() const noexcept
{
    const OperatorLimb& hand = options_.hand;
    return 0.5 * (options_.device.mass_kg * device_m_per_s_.squaredNorm() +
                  hand.mass_kg * hand_m_per_s_.squaredNorm() +
                  hand.grip_stiffness_n_per_m * (hand_m_ - device_m_).squaredNorm() +
                  hand.stiffness_n_per_m * (target_m_ - hand_m_).squaredNorm());
}

} // namespace tactus
