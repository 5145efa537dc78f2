// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/simulated/simulated_device.hpp"

#include "platform/devices/device_force.hpp"
#include "rt_core/math/value_range.hpp"

#include <algorithm>
#include <utility>

namespace tactus
{

namespace
{

constexpr std::int64_t kSecondNs = 1'000'000'000;

/// Fault of the options; empty if none.
std::string find_bad_option(const SimulatedDeviceOptions& options)
{
    if (options.rate_hz < SimulatedDeviceOptions::kRateMinHz ||
        options.rate_hz > SimulatedDeviceOptions::kRateMaxHz)
    {
        return "simulated device: rate " + std::to_string(options.rate_hz) +
               " Hz is out of range 100..10000 Hz";
    }
    if (!is_positive(options.speed_max_m_per_s) ||
        !is_not_negative(options.brake_damping_n_s_per_m) ||
        !is_not_negative(options.brake_damping_nm_s_per_rad) ||
        !is_not_negative(options.gripper_force_max_n) || !is_not_negative(options.load.mass_kg))
    {
        return "simulated device: the largest speed must be finite and above zero; the brake's "
               "dampings, the gripper's force and the load's mass must be finite and not negative";
    }
    if (options.watchdog && (*options.watchdog <= Duration{} || options.clock == nullptr))
    {
        return "simulated device: a watchdog needs a time above zero, and a clock";
    }
    return {};
}

/// Sets the brake of a body that moves or rotates.
void set_brake(auto& body, bool is_on, double damping) noexcept
{
    if (is_on)
    {
        body.brake(damping);
    }
    else
    {
        body.release_brake();
    }
}

} // namespace

Result<std::unique_ptr<SimulatedDevice>, Refusal>
SimulatedDevice::create(const SimulatedDeviceOptions& options,
                        std::unique_ptr<OperatorMotion> motion)
{
    TACTUS_ASSERT(motion != nullptr);
    if (std::string wrong = find_bad_option(options); !wrong.empty())
    {
        return Refusal{std::move(wrong)};
    }
    const auto body = OperatorAndDevice::create(
        {options.device, options.hand, 1.0 / static_cast<double>(options.rate_hz),
         motion->start_world_m(), options.workspace_centre_world_m, options.workspace_radius_m});
    if (!body)
    {
        return body.error();
    }
    std::optional<OperatorRotation> rotation;
    if (options.device.rotation.is_measured)
    {
        const auto made = OperatorRotation::create(
            {options.device.rotation, options.device.delay_s, options.wrist,
             1.0 / static_cast<double>(options.rate_hz), motion->grip().rotation});
        if (!made)
        {
            return made.error();
        }
        rotation = made.value();
    }
    return std::unique_ptr<SimulatedDevice>(
        new SimulatedDevice(options, body.value(), rotation, std::move(motion)));
}

SimulatedDevice::SimulatedDevice(const SimulatedDeviceOptions& options,
                                 const OperatorAndDevice& body,
                                 const std::optional<OperatorRotation>& rotation,
                                 std::unique_ptr<OperatorMotion> motion)
    : options_(options)
    , info_{"sim",
            options.device,
            to_array(options.workspace_centre_world_m),
            options.workspace_radius_m,
            options.speed_max_m_per_s,
            SimulatedDeviceOptions::kRateMinHz,
            SimulatedDeviceOptions::kRateMaxHz,
            motion->grip().gripper_m ? options.gripper_force_max_n : 0.0}
    , motion_(std::move(motion))
    , body_(body)
    , rotation_(rotation)
{
}

DeviceSample SimulatedDevice::read() noexcept
{
    start_ = status_.frames == 0 ? now() : start_;
    for (std::uint64_t due = periods_due(); due > 0; --due)
    {
        const MonotonicTime time = options_.clock == nullptr ? now() : start_ + period_at(periods_);
        ++periods_;
        integrate_one_period(brake_.is_on_at(time), wrench_at(time));
    }
    read_at_ns_.store(period_at(periods_).ns, std::memory_order_relaxed);
    DeviceSample sample;
    sample.position_world_m = to_array(body_.measured_m());
    sample.velocity_world_m_per_s = to_array(body_.velocity_m_per_s());
    sample.time = MonotonicTime{period_at(periods_).ns};
    sample.frame = status_.frames++;
    sample.valid = true;
    if (rotation_)
    {
        sample.rotation_world = rotation_->measured();
        sample.angular_velocity_world_rad_per_s = to_array(rotation_->velocity_rad_per_s());
    }
    const OperatorGrip grip = motion_->grip();
    sample.buttons = grip.buttons;
    sample.gripper_m = grip.gripper_m;
    return sample;
}

std::uint64_t SimulatedDevice::periods_due() const noexcept
{
    if (status_.frames == 0)
    {
        return 0;
    }
    if (options_.clock == nullptr)
    {
        return 1;
    }
    // A reading is at least a period after the last, or its time would not advance; after a long
    // pause it catches up by at most one second.
    const std::int64_t since_ns = (now() - start_).ns;
    const std::int64_t gone = since_ns / kSecondNs * options_.rate_hz +
                              since_ns % kSecondNs * options_.rate_hz / kSecondNs;
    const std::int64_t due = gone - static_cast<std::int64_t>(periods_);
    return static_cast<std::uint64_t>(std::clamp<std::int64_t>(due, 1, options_.rate_hz));
}

/// Time of `index` periods. A sum of rounded periods would drift at rates without a whole period in
/// ns.
Duration SimulatedDevice::period_at(std::uint64_t index) const noexcept
{
    const auto whole_s = static_cast<std::int64_t>(index) / options_.rate_hz;
    const auto rest = static_cast<std::int64_t>(index) % options_.rate_hz;
    return {whole_s * kSecondNs + rest * kSecondNs / options_.rate_hz};
}

MonotonicTime SimulatedDevice::now() const noexcept
{
    return options_.clock == nullptr ? MonotonicTime{read_at_ns_.load(std::memory_order_relaxed)}
                                     : options_.clock->now();
}

/// True if the device's watchdog has ended the force before `time`.
bool SimulatedDevice::is_watched_out(MonotonicTime time) const noexcept
{
    return options_.watchdog && time - written_ >= *options_.watchdog;
}

/// Part of the last written wrench that brake and watchdog leave at `time`.
Wrench SimulatedDevice::wrench_at(MonotonicTime time) const noexcept
{
    const double share = is_watched_out(time) ? 0.0 : brake_.share_at(time);
    if (share == 1.0)
    {
        return wrench_;
    }
    return {to_array(share * to_vec3(wrench_.force_world_n)),
            to_array(share * to_vec3(wrench_.torque_world_nm)), share * wrench_.gripper_force_n};
}

Vec3 SimulatedDevice::felt_force_world_n() const noexcept
{
    return to_vec3(felt_wrench().force_world_n);
}

Wrench SimulatedDevice::felt_wrench() const noexcept
{
    return wrench_at(now());
}

void SimulatedDevice::integrate_one_period(bool braked, const Wrench& wrench) noexcept
{
    const Mat3 rotation = rotation_ ? rotation_->rotation() : Mat3::Identity();
    const Vec3 weight_n = options_.load.weight_n() * options_.load.down_world;
    const Vec3 force_n = to_vec3(wrench.force_world_n) + weight_n;
    const Vec3 torque_nm =
        to_vec3(wrench.torque_world_nm) + (rotation * options_.load.centre_m).cross(weight_n);
    set_brake(body_, braked, options_.brake_damping_n_s_per_m);
    OperatorSense sense{periods_, body_.position_m(), force_n};
    sense.device_rotation = rotation_ ? rotation_->rotation() : sense.device_rotation;
    sense.torque_world_nm = torque_nm;
    const Vec3 target_m = motion_->next_world_m(sense);
    static_cast<void>(body_.step(force_n, target_m));
    if (rotation_)
    {
        set_brake(*rotation_, braked, options_.brake_damping_nm_s_per_rad);
        rotation_->step(torque_nm, motion_->grip().rotation);
    }
}

void SimulatedDevice::write(const Wrench& wrench) noexcept
{
    if (!brake_.lets_through())
    {
        return;
    }
    written_ = now();
    wrench_ = take_wrench(wrench, info_, status_);
    status_.state = DeviceState::force;
}

void SimulatedDevice::brake() noexcept
{
    brake_.brake(now());
}

void SimulatedDevice::brake_softly() noexcept
{
    brake_.brake_softly(now());
}

void SimulatedDevice::release_brake() noexcept
{
    if (brake_.try_yield(now()))
    {
        return;
    }
    wrench_ = {};
    status_.state = DeviceState::idle;
    brake_.release();
}

DeviceStatus SimulatedDevice::status() const noexcept
{
    DeviceStatus status = status_;
    if (brake_.is_on())
    {
        const bool has_force = status.state == DeviceState::force && !is_watched_out(now());
        status.force_left = has_force ? brake_.share_at(now()) : 0.0;
        status.state = DeviceState::brake;
    }
    else if (is_watched_out(now()))
    {
        status.state = DeviceState::idle;
    }
    return status;
}

} // namespace tactus
