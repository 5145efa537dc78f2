// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Device for --device plugin:FILE,LOG that logs its motors in LOG, one line a change: monotonic
/// time in ns, force in N, and its source: `force`, `brake`, or `guard`, the guardian. The last
/// line is the motors' lasting state. Its hand moves along z by 2 cm in 4 s. With HAS_NO_GUARD the
/// library has no guard. With ",refuse" after the log's name the guard refuses to start.

#include "platform/devices/plugin/device_plugin.hpp"

#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fcntl.h>
#include <string>
#include <string_view>
#include <unistd.h>

namespace
{

using namespace tactus;

std::int64_t now_ns()
{
    std::timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

std::string log_of(const DeviceRequest& request)
{
    const std::string_view words = request.words;
    return std::string(words.substr(0, words.find(',')));
}

/// Motors, which outlive the programs that drive them.
class Motors
{
public:
    explicit Motors(const std::string& log)
        : file_(::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644))
    {
    }
    Motors(const Motors&) = delete;
    Motors& operator=(const Motors&) = delete;
    ~Motors() { ::close(file_); }

    void set(const std::array<double, 3>& force_n, const char* who) const noexcept
    {
        std::array<char, 160> line{};
        const int length = std::snprintf(line.data(), line.size(), "%lld %.6f %.6f %.6f %s\n",
                                         static_cast<long long>(now_ns()), force_n[0], force_n[1],
                                         force_n[2], who);
        [[maybe_unused]] const ssize_t written =
            ::write(file_, line.data(), static_cast<std::size_t>(length));
    }

private:
    int file_;
};

class Recording final : public HapticDevice
{
public:
    explicit Recording(const DeviceRequest& request)
        : frame_(request.frame), motors_(log_of(request)), start_ns_(now_ns())
    {
        DeviceInfo info;
        info.name = "recording";
        info.limits = {.mass_kg = 0.1, .damping_n_s_per_m = 1.0, .force_max_n = 8.0};
        info.workspace_radius_m = 0.1;
        info.speed_max_m_per_s = 2.0;
        info.rate_min_hz = 100;
        info.rate_max_hz = 10'000;
        info_ = frame_.to_world(info);
    }

    [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
    [[nodiscard]] DeviceSample read() noexcept override
    {
        DeviceSample sample;
        const std::int64_t since_ns = now_ns() - start_ns_;
        const double height_m = 0.02 * std::cos(1.5707963 * 1e-9 * static_cast<double>(since_ns));
        const Vec3 place_m = frame_.position_to_world({0.0, 0.0, height_m});
        sample.position_world_m = {place_m.x(), place_m.y(), place_m.z()};
        sample.time = MonotonicTime{since_ns};
        sample.frame = status_.frames++;
        sample.valid = true;
        return sample;
    }
    void write(const Wrench& wrench) noexcept override
    {
        if (!is_braked_.load())
        {
            motors_.set(wrench.force_world_n, "force");
            status_.state = DeviceState::force;
        }
    }
    void brake() noexcept override
    {
        is_braked_.store(true);
        motors_.set({}, "brake");
    }
    void release_brake() noexcept override { is_braked_.store(false); }
    [[nodiscard]] DeviceStatus status() const noexcept override
    {
        DeviceStatus status = status_;
        status.state = is_braked_.load() ? DeviceState::brake : status.state;
        return status;
    }

private:
    DeviceFrame frame_;
    DeviceInfo info_;
    Motors motors_;
    std::int64_t start_ns_;
    DeviceStatus status_;
    std::atomic<bool> is_braked_{false};
};

Result<std::unique_ptr<HapticDevice>, Refusal> make_recording(const DeviceRequest& request)
{
    return std::unique_ptr<HapticDevice>(std::make_unique<Recording>(request));
}

#ifndef HAS_NO_GUARD
class Guard final : public DeviceGuard
{
public:
    explicit Guard(const DeviceRequest& request) : motors_(log_of(request)) {}

    [[nodiscard]] bool brake() noexcept override
    {
        motors_.set({}, "guard");
        return true;
    }

private:
    Motors motors_;
};

Result<std::unique_ptr<DeviceGuard>, Refusal> make_guard(const DeviceRequest& request)
{
    if (std::string_view(request.words).ends_with(",refuse"))
    {
        return Refusal{"its motors have one line, which is taken"};
    }
    return std::unique_ptr<DeviceGuard>(std::make_unique<Guard>(request));
}
#endif

} // namespace

#ifndef HAS_NO_GUARD
TACTUS_DEVICE_PLUGIN(make_recording, make_guard);
#else
TACTUS_DEVICE_PLUGIN(make_recording);
#endif
