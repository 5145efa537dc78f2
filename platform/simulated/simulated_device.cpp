// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/simulated/simulated_device.hpp"

#include "platform/device_force.hpp"
#include "rt_core/math/value_range.hpp"

#include <algorithm>
#include <utility>

namespace tactus
{

namespace
{

constexpr std::int64_t kSecondNs = 1'000'000'000;

/// Empty when all options are good.
std::string find_bad_option(const SimulatedDeviceOptions& options)
{
    if (options.rate_hz < SimulatedDeviceOptions::kRateMinHz ||
        options.rate_hz > SimulatedDeviceOptions::kRateMaxHz)
    {
        return "simulated device: rate " + std::to_string(options.rate_hz) +
               " Hz is out of range 100..10000 Hz";
    }
    if (!is_positive(options.speed_max_m_per_s) ||
        !is_not_negative(options.brake_damping_n_s_per_m))
    {
        return "simulated device: the largest speed must be finite and above zero, the brake's "
               "damping finite and not negative";
    }
    if (options.watchdog && (*options.watchdog <= Duration{} || options.clock == nullptr))
    {
        return "simulated device: a watchdog needs a time above zero, and a clock";
    }
    return {};
}

} // namespace

Result<std::unique_ptr<SimulatedDevice>, Refusal>
SimulatedDevice::create(const SimulatedDeviceOptions& options, std::unique_ptr<HandMotion> hand)
{
    TACTUS_ASSERT(hand != nullptr);
    if (std::string wrong = find_bad_option(options); !wrong.empty())
    {
        return Refusal{std::move(wrong)};
    }
    const auto body = HandAndDevice::create(
        {options.device, options.hand, 1.0 / static_cast<double>(options.rate_hz),
         hand->start_world_m(), options.workspace_centre_world_m, options.workspace_radius_m});
    if (!body)
    {
        return body.error();
    }
    return std::unique_ptr<SimulatedDevice>(
        new SimulatedDevice(options, body.value(), std::move(hand)));
}

SimulatedDevice::SimulatedDevice(const SimulatedDeviceOptions& options, const HandAndDevice& body,
                                 std::unique_ptr<HandMotion> hand)
    : options_(options)
    , info_{"sim",
            options.device,
            to_array(options.workspace_centre_world_m),
            options.workspace_radius_m,
            options.speed_max_m_per_s,
            SimulatedDeviceOptions::kRateMinHz,
            SimulatedDeviceOptions::kRateMaxHz}
    , hand_(std::move(hand))
    , body_(body)
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
    return {to_array(body_.measured_m()), to_array(body_.velocity_m_per_s()),
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
    if (braked)
    {
        body_.brake(options_.brake_damping_n_s_per_m);
    }
    else
    {
        body_.release_brake();
    }
    const Vec3 target_m = hand_->next_world_m({periods_, body_.position_m(), force_n});
    static_cast<void>(body_.step(force_n, target_m));
}

void SimulatedDevice::write(const std::array<double, 3>& force_world_n) noexcept
{
    if (braked_at_ns_.load() != kNever)
    {
        return;
    }
    written_ = now();
    force_world_n_ = take_force(force_world_n, options_.device.force_max_n, status_);
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
