// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/simulated/simulated_device.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus
{

namespace
{

constexpr std::int64_t kSecondNs = 1'000'000'000;
/// With 0.1 kg this keeps a wall of 3,000 N/m at 0.02 rad a sub-step: far from instability.
constexpr std::int64_t kSubStepMaxNs = 125'000;

constexpr std::int64_t sub_steps(std::int64_t rate_hz) noexcept
{
    return (kSecondNs / rate_hz + kSubStepMaxNs - 1) / kSubStepMaxNs;
}

double sub_step_s(std::int64_t rate_hz) noexcept
{
    return 1.0 / static_cast<double>(rate_hz * sub_steps(rate_hz));
}

std::array<double, 3> to_array(const Vec3& v) noexcept
{
    return {v.x(), v.y(), v.z()};
}

bool is_positive(double value) noexcept
{
    return std::isfinite(value) && value > 0.0;
}

bool is_not_negative(double value) noexcept
{
    return std::isfinite(value) && value >= 0.0;
}

/// Semi-implicit Euler on mass, spring and damper stays stable while k dt^2 + 2 b dt < 4 m;
/// half of that keeps it accurate too.
bool is_stable(const SimulatedDeviceOptions& options) noexcept
{
    const double dt = sub_step_s(options.rate_hz);
    const double damping = options.device_damping_n_s_per_m + options.hand_damping_n_s_per_m +
                           options.brake_damping_n_s_per_m;
    const double stiffness = options.hand_stiffness_n_per_m + options.stiffness_max_n_per_m;
    return stiffness * dt * dt + 2.0 * damping * dt < 2.0 * options.mass_kg;
}

/// Empty when all options are good.
std::string find_bad_option(const SimulatedDeviceOptions& options, const Vec3& start_world_m)
{
    if (options.rate_hz < SimulatedDeviceOptions::kRateMinHz ||
        options.rate_hz > SimulatedDeviceOptions::kRateMaxHz)
    {
        return "simulated device: rate " + std::to_string(options.rate_hz) +
               " Hz is out of range 100..10000 Hz";
    }
    if (!is_positive(options.mass_kg) || !is_positive(options.hand_stiffness_n_per_m) ||
        !is_positive(options.force_max_n) || !is_positive(options.stiffness_max_n_per_m) ||
        !is_positive(options.workspace_radius_m) || !is_positive(options.speed_max_m_per_s))
    {
        return "simulated device: mass, stiffnesses, largest force, workspace radius and largest "
               "speed must be finite and above zero";
    }
    if (!is_not_negative(options.device_damping_n_s_per_m) ||
        !is_not_negative(options.hand_damping_n_s_per_m) ||
        !is_not_negative(options.brake_damping_n_s_per_m))
    {
        return "simulated device: dampings must be finite and not negative";
    }
    if (options.watchdog && (*options.watchdog <= Duration{} || options.clock == nullptr))
    {
        return "simulated device: a watchdog needs a time above zero, and a clock";
    }
    if (!is_stable(options))
    {
        return "simulated device: stiffness or damping is too large for the mass at " +
               std::to_string(options.rate_hz) + " Hz; take a larger mass or a higher rate";
    }
    const double from_centre_m = (start_world_m - options.workspace_centre_world_m).norm();
    if (!(from_centre_m <= options.workspace_radius_m))
    {
        return "simulated device: the hand starts " + std::to_string(from_centre_m) +
               " m from the workspace centre, outside its radius of " +
               std::to_string(options.workspace_radius_m) + " m";
    }
    return {};
}

} // namespace

Result<std::unique_ptr<SimulatedDevice>, PlatformError>
SimulatedDevice::create(const SimulatedDeviceOptions& options, std::unique_ptr<HandMotion> hand)
{
    TACTUS_ASSERT(hand != nullptr);
    if (std::string wrong = find_bad_option(options, hand->start_world_m()); !wrong.empty())
    {
        return PlatformError{PlatformErrorKind::bad_option, std::move(wrong)};
    }
    return std::unique_ptr<SimulatedDevice>(new SimulatedDevice(options, std::move(hand)));
}

SimulatedDevice::SimulatedDevice(const SimulatedDeviceOptions& options,
                                 std::unique_ptr<HandMotion> hand)
    : options_(options)
    , info_{"sim",
            {.mass_kg = options.mass_kg,
             .damping_n_s_per_m = options.device_damping_n_s_per_m,
             .force_max_n = options.force_max_n,
             .stiffness_max_n_per_m = options.stiffness_max_n_per_m},
            to_array(options.workspace_centre_world_m),
            options.workspace_radius_m,
            options.speed_max_m_per_s,
            SimulatedDeviceOptions::kRateMinHz,
            SimulatedDeviceOptions::kRateMaxHz}
    , hand_(std::move(hand))
    , hand_world_m_(hand_->start_world_m())
    , position_world_m_(hand_world_m_)
{
}

DeviceSample SimulatedDevice::read() noexcept
{
    start_ = status_.frames == 0 ? now() : start_;
    for (std::uint64_t due = periods_due(); due > 0; --due)
    {
        const MonotonicTime time = options_.clock == nullptr ? now() : start_ + period_at(periods_);
        ++periods_;
        integrate_one_period(time.ns >= braked_at_ns_.load(),
                             makes_force_at(time) ? force_world_n_ : Vec3(Vec3::Zero()));
    }
    const std::uint64_t frame = status_.frames++;
    return {to_array(position_world_m_), to_array(velocity_world_m_per_s_),
            MonotonicTime{period_at(periods_).ns}, frame, true};
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
    // A reading is at least a period after the last, or its time would stand still; one after a
    // long pause catches up on a second of it and no more.
    const std::int64_t since_ns = (now() - start_).ns;
    const std::int64_t gone = since_ns / kSecondNs * options_.rate_hz +
                              since_ns % kSecondNs * options_.rate_hz / kSecondNs;
    const std::int64_t due = gone - static_cast<std::int64_t>(periods_);
    return static_cast<std::uint64_t>(std::clamp<std::int64_t>(due, 1, options_.rate_hz));
}

/// From the index, not summed up, so that rates without a whole period in ns do not drift.
Duration SimulatedDevice::period_at(std::uint64_t index) const noexcept
{
    const auto whole_s = static_cast<std::int64_t>(index) / options_.rate_hz;
    const auto rest = static_cast<std::int64_t>(index) % options_.rate_hz;
    return {whole_s * kSecondNs + rest * kSecondNs / options_.rate_hz};
}

MonotonicTime SimulatedDevice::now() const noexcept
{
    return options_.clock == nullptr ? MonotonicTime{} : options_.clock->now();
}

bool SimulatedDevice::makes_force_at(MonotonicTime time) const noexcept
{
    const bool watched = options_.watchdog && time - written_ >= *options_.watchdog;
    return time.ns < braked_at_ns_.load() && !watched;
}

Vec3 SimulatedDevice::felt_force_world_n() const noexcept
{
    return makes_force_at(now()) ? force_world_n_ : Vec3(Vec3::Zero());
}

void SimulatedDevice::integrate_one_period(bool braked, const Vec3& force_n) noexcept
{
    const Vec3 hand_end_m = hand_->next_world_m({periods_, position_world_m_, force_n});
    const std::int64_t steps = sub_steps(options_.rate_hz);
    const double dt = sub_step_s(options_.rate_hz);
    const Vec3 hand_velocity = (hand_end_m - hand_world_m_) / (dt * static_cast<double>(steps));
    const double ground_damping =
        options_.device_damping_n_s_per_m + (braked ? options_.brake_damping_n_s_per_m : 0.0);
    for (std::int64_t step = 0; step < steps; ++step)
    {
        const Vec3 spring_n = (hand_world_m_ - position_world_m_) * options_.hand_stiffness_n_per_m;
        const Vec3 damper_n =
            (hand_velocity - velocity_world_m_per_s_) * options_.hand_damping_n_s_per_m;
        const Vec3 total_n =
            spring_n + damper_n + force_n - velocity_world_m_per_s_ * ground_damping;
        velocity_world_m_per_s_ += total_n * (dt / options_.mass_kg);
        position_world_m_ += velocity_world_m_per_s_ * dt;
        stay_in_workspace();
        hand_world_m_ += hand_velocity * dt;
    }
    hand_world_m_ = hand_end_m;
}

/// The reach ends in a stop without bounce: the outward part of the velocity is lost.
void SimulatedDevice::stay_in_workspace() noexcept
{
    const Vec3 from_centre_m = position_world_m_ - options_.workspace_centre_world_m;
    const double distance_m = from_centre_m.norm();
    if (distance_m <= options_.workspace_radius_m)
    {
        return;
    }
    const Vec3 outward = from_centre_m / distance_m;
    position_world_m_ = options_.workspace_centre_world_m + outward * options_.workspace_radius_m;
    const double speed_out = velocity_world_m_per_s_.dot(outward);
    if (speed_out > 0.0)
    {
        velocity_world_m_per_s_ -= outward * speed_out;
    }
}

void SimulatedDevice::write(const std::array<double, 3>& force_world_n) noexcept
{
    if (braked_at_ns_.load() != kNever)
    {
        return;
    }
    written_ = now();
    Vec3 force_n{force_world_n[0], force_world_n[1], force_world_n[2]};
    const double norm_n = force_n.norm();
    if (!std::isfinite(norm_n))
    {
        ++status_.forces_refused;
        force_n.setZero();
    }
    else if (norm_n > options_.force_max_n)
    {
        ++status_.forces_clamped;
        force_n *= options_.force_max_n / norm_n;
    }
    force_world_n_ = force_n;
    status_.state = DeviceState::force;
}

void SimulatedDevice::brake() noexcept
{
    std::int64_t never = kNever;
    braked_at_ns_.compare_exchange_strong(never, now().ns);
}

void SimulatedDevice::release_brake() noexcept
{
    force_world_n_.setZero();
    status_.state = DeviceState::idle;
    braked_at_ns_.store(kNever);
}

DeviceStatus SimulatedDevice::status() const noexcept
{
    DeviceStatus status = status_;
    if (braked_at_ns_.load() != kNever)
    {
        status.state = DeviceState::brake;
    }
    else if (!makes_force_at(now()))
    {
        status.state = DeviceState::idle;
    }
    return status;
}

} // namespace tactus
