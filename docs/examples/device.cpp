// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
//
// A device of one's own, for `hrtc --device plugin:FILE,HEIGHT`: here a handle on a rail
// along z, that somebody draws up and down by HEIGHT metres twice in 4 s, and that gives way to the
// force by 1 mm a newton. Where it is computed, a real one asks its hardware.
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <tactus/platform/devices/plugin/device_plugin.hpp>

using namespace tactus;

namespace
{

class Rail final : public HapticDevice
{
public:
    Rail(const DeviceRequest& request, double height_m)
        : frame_(request.frame), height_m_(height_m), period_ns_(1'000'000'000 / request.rate_hz)
    {
        DeviceInfo info;
        info.name = "rail";
        info.limits = {.mass_kg = 0.1, .damping_n_s_per_m = 1.0, .force_max_n = 8.0};
        info.workspace_radius_m = height_m;
        info.speed_max_m_per_s = 2.0;
        info.rate_min_hz = 100;
        info.rate_max_hz = 10'000;
        info_ = frame_.to_world(info);
    }

    [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }

    // On the haptic thread, once a period: neither waits nor allocates.
    [[nodiscard]] DeviceSample read() noexcept override
    {
        DeviceSample sample;
        const std::int64_t time_ns = period_ns_ * static_cast<std::int64_t>(status_.frames);
        const double height_m = height_m_ * std::cos(3.14159265 * 1e-9 * double(time_ns));
        const Vec3 place_m = frame_.position_to_world({0.0, 0.0, height_m + 1e-3 * force_z_n_});
        sample.position_world_m = {place_m.x(), place_m.y(), place_m.z()};
        sample.time = MonotonicTime{time_ns};
        sample.frame = status_.frames++;
        sample.valid = true;
        return sample;
    }
    void write(const Wrench& wrench) noexcept override
    {
        const auto& [x, y, z] = wrench.force_world_n;
        const bool is_free = status_.state != DeviceState::brake;
        force_z_n_ = is_free ? frame_.force_to_device({x, y, z}).z() : 0.0;
        status_.state = is_free ? DeviceState::force : DeviceState::brake;
    }
    // From any thread, when hrtc is silent: a real device damps its motors here.
    void brake() noexcept override { status_.state = DeviceState::brake; }
    void release_brake() noexcept override { status_.state = DeviceState::idle; }
    [[nodiscard]] DeviceStatus status() const noexcept override { return status_; }

private:
    DeviceFrame frame_;
    DeviceInfo info_;
    DeviceStatus status_;
    double height_m_;
    std::int64_t period_ns_;
    double force_z_n_{0.0};
};

Result<std::unique_ptr<HapticDevice>, Refusal> make_rail(const DeviceRequest& request)
{
    const double height_m = std::atof(request.words);
    if (!(height_m > 0.0 && height_m <= 1.0))
    {
        return Refusal{"give its height, 0 to 1 m, behind a comma"};
    }
    return std::unique_ptr<HapticDevice>(std::make_unique<Rail>(request, height_m));
}

// A real one talks to its hardware. This rail ends with its program.
bool stop_motors()
{
    return true;
}

class RailGuard final : public DeviceGuard
{
public:
    bool brake() noexcept override { return stop_motors(); }
};

Result<std::unique_ptr<DeviceGuard>, Refusal> make_rail_guard(const DeviceRequest& /*request*/)
{
    return std::unique_ptr<DeviceGuard>(std::make_unique<RailGuard>());
}

} // namespace

TACTUS_DEVICE_PLUGIN(make_rail, make_rail_guard);
