// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/dhd/dhd_device.hpp"

#include "platform/base/printable.hpp"
#include "platform/remote/info_fault.hpp"
#include "rt_core/limits.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

namespace tactus
{

namespace
{

Refusal refuse_device(std::string line)
{
    return {"dhd device: " + std::move(line)};
}

/// Empty when all options are good; the name is looked at later.
std::string find_bad_option(const DhdDeviceOptions& options)
{
    if (options.index < 0 || options.index > DhdDeviceOptions::kIndexMax)
    {
        return "dhd device: index " + std::to_string(options.index) + " is out of range 0..63";
    }
    if (options.period < DhdDeviceOptions::kPeriodMin ||
        options.period > DhdDeviceOptions::kPeriodMax)
    {
        return "dhd device: the period must be in range 100 us..10 ms";
    }
    if (options.deadman_button && (*options.deadman_button < 0 || *options.deadman_button > 15))
    {
        return "dhd device: the button must be in range 0..15";
    }
    return find_bad_time(options.times);
}

std::string last_error(const DhdLibrary& library)
{
    const char* text = library->dhdErrorGetLastStr();
    return text == nullptr ? "no reason given" : text;
}

/// What the SDK calls the device, as far as that may be shown.
std::string system_name(const DhdLibrary& library, char id)
{
    const char* text = library->dhdGetSystemName(id);
    std::string name = text == nullptr ? "" : text;
    std::erase_if(name, [](char c) { return !is_printable(c); });
    name.resize(std::min(name.size(), kDeviceNameMax));
    return name.empty() ? "dhd" : name;
}

Result<char, Refusal> open_device(const DhdLibrary& library, int index)
{
    const int count = library->dhdGetDeviceCount();
    if (count <= 0)
    {
        return refuse_device(
            "the SDK finds none; is it plugged in and switched on, and may this user "
            "open USB devices?");
    }
    if (index >= count)
    {
        return refuse_device("there is no device " + std::to_string(index) + ", they are 0.." +
                             std::to_string(count - 1));
    }
    const int id = library->dhdOpenID(static_cast<char>(index));
    if (id < 0)
    {
        return refuse_device("device " + std::to_string(index) + " can't be opened (" +
                             last_error(library) + ")");
    }
    return static_cast<char>(id);
}

bool is_usable(const Vec3& v) noexcept
{
    return std::abs(v.x()) <= kGoalRange_m && std::abs(v.y()) <= kGoalRange_m &&
           std::abs(v.z()) <= kGoalRange_m;
}

} // namespace

/// The omega class of platform/simulated/device_classes.hpp with the force and the stiffness of the
/// weakest device, and a turn and two transfers of delay.
DeviceInfo DhdDeviceOptions::default_info()
{
    DeviceInfo info;
    info.limits = {.mass_kg = 0.2,
                   .damping_n_s_per_m = 1.7,
                   .friction_n = 0.05,
                   .quantum_m = 20e-6,
                   .delay_s = 450e-6,
                   .force_max_n = 8.0,
                   .slew_max_n_per_s = 16'000.0,
                   .stiffness_max_n_per_m = 3'000.0,
                   .added_damping_max_n_s_per_m = 10.0};
    info.workspace_radius_m = 0.5;
    info.speed_max_m_per_s = 10.0;
    info.rate_min_hz = 100;
    info.rate_max_hz = 4'000;
    return info;
}

Result<std::unique_ptr<DhdDevice>, Refusal> DhdDevice::create(const DhdDeviceOptions& options)
{
    TACTUS_ASSERT(options.clock != nullptr);
    if (std::string wrong = find_bad_option(options); !wrong.empty())
    {
        return Refusal{std::move(wrong)};
    }
    auto library = DhdLibrary::load(options.library);
    if (!library)
    {
        return library.error();
    }
    const auto id = open_device(library.value(), options.index);
    if (!id)
    {
        return id.error();
    }
    DeviceInfo info = options.info;
    info.name = info.name.empty() ? system_name(library.value(), id.value()) : info.name;
    std::unique_ptr<DhdDevice> device(
        new DhdDevice(std::move(library).value(), id.value(), info, options)); // Closes it, too.
    if (const char* fault = find_fault(info); fault != nullptr)
    {
        return Refusal{fault};
    }
    auto thread = RtThread::start(options.thread, [raw = device.get()] { raw->run(); });
    if (!thread)
    {
        return thread.error();
    }
    device->thread_ = std::move(thread).value();
    return device;
}

DhdDevice::DhdDevice(DhdLibrary library, char id, const DeviceInfo& info,
                     const DhdDeviceOptions& options)
    : RemoteDevice(info, options.frame, options.times, *options.clock)
    , library_(std::move(library))
    , index_(static_cast<char>(options.index))
    , deadman_button_(options.deadman_button)
    , period_(options.period)
    , id_(id)
{
}

DhdDevice::~DhdDevice()
{
    is_stopped_.store(true);
    thread_.reset();
    if (is_open_)
    {
        library_->dhdSetForce(0.0, 0.0, 0.0, id_);
        library_->dhdEnableForce(0, id_);
        library_->dhdClose(id_);
    }
}

void DhdDevice::run() noexcept
{
    while (!is_stopped_.load())
    {
        const MonotonicTime start = clock().now();
        if (!is_open_)
        {
            find_again();
        }
        if (is_open_ && !turn())
        {
            lose();
        }
        const Duration rest = start + (is_open_ ? period_ : kReopen) - clock().now();
        std::this_thread::sleep_for(std::chrono::nanoseconds(rest.ns));
    }
}

/// False when the device doesn't answer.
bool DhdDevice::turn() noexcept
{
    return publish_reading() && obey(command());
}

/// A position that is no number is the SDK's failure, not the end of the device. Without a velocity
/// whoever needs one takes differences.
bool DhdDevice::publish_reading() noexcept
{
    DeviceReading reading;
    Vec3 velocity(0.0, 0.0, 0.0);
    Vec3& position = reading.position_m;
    if (library_->dhdGetPosition(&position.x(), &position.y(), &position.z(), id_) < 0)
    {
        return false;
    }
    reading.arrival = clock().now();
    reading.time = reading.arrival;
    reading.valid = is_usable(position);
    if (library_->dhdGetLinearVelocity(&velocity.x(), &velocity.y(), &velocity.z(), id_) >= 0 &&
        is_usable(velocity))
    {
        reading.velocity_m_per_s = velocity;
    }
    reading.deadman_held = is_held();
    publish(reading, std::exchange(is_new_, false));
    return true;
}

/// A button that can't be read isn't held.
bool DhdDevice::is_held() const noexcept
{
    return !deadman_button_ || library_->dhdGetButton(*deadman_button_, id_) == 1;
}

/// Not every device has brakes; that there is no force is what counts.
bool DhdDevice::obey(const DeviceCommand& command) noexcept
{
    const DhdFunctions& sdk = *library_;
    const Vec3& force_n = command.force_n;
    bool is_done = true;
    if (command.state == DeviceState::brake)
    {
        const bool is_free = sdk.dhdSetForce(0.0, 0.0, 0.0, id_) >= 0;
        const bool is_braked = sdk.dhdSetBrakes(1, id_) >= 0;
        is_done = is_free || is_braked;
    }
    else
    {
        if (!makes_forces_)
        {
            static_cast<void>(sdk.dhdSetBrakes(0, id_));
            is_done = sdk.dhdEnableForce(1, id_) >= 0;
        }
        is_done = is_done && sdk.dhdSetForce(force_n.x(), force_n.y(), force_n.z(), id_) >= 0;
    }
    makes_forces_ = is_done && command.state != DeviceState::brake;
    return is_done;
}

void DhdDevice::lose() noexcept
{
    detach();
    library_->dhdClose(id_);
    is_open_ = false;
}

void DhdDevice::find_again() noexcept
{
    const int id = index_ < library_->dhdGetDeviceCount() ? library_->dhdOpenID(index_) : -1;
    if (id >= 0)
    {
        id_ = static_cast<char>(id);
        is_open_ = true;
        is_new_ = true;
        makes_forces_ = false;
    }
}

} // namespace tactus
