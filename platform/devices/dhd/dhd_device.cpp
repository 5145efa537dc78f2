// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/dhd/dhd_device.hpp"

#include "platform/devices/remote/remote_values.hpp"
#include "rt_core/limits.hpp"
#include "transport/base/printable.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>
#include <utility>

namespace tactus
{

namespace
{

/// Tolerance of the SDK's rotation matrices, which are products of calibrated joints.
constexpr double kFrameTolerance = 1e-3;

/// Time step of the SDK's watchdog.
constexpr Duration kWatchdogStep = microseconds(125);

/// Watchdog steps of this time, up to the SDK's maximum: 32 ms.
std::uint8_t watchdog_steps(Duration time)
{
    return static_cast<std::uint8_t>(std::min<std::int64_t>(
        time.ns / kWatchdogStep.ns, std::numeric_limits<std::uint8_t>::max()));
}

Refusal refuse_device(std::string line)
{
    return {"dhd device: " + std::move(line)};
}

/// Fault of the options, empty if none; the name is checked later.
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

/// Name of the device in the SDK, reduced to printable characters.
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
        return refuse_device("the SDK finds no device; check the cable, the power and the right of "
                             "this user to open USB devices");
    }
    if (index >= count)
    {
        return refuse_device("there is no device " + std::to_string(index) +
                             "; the devices are 0.." + std::to_string(count - 1));
    }
    const int id = library->dhdOpenID(static_cast<char>(index));
    if (id < 0)
    {
        return refuse_device("device " + std::to_string(index) + " can't be opened (" +
                             last_error(library) + ")");
    }
    return static_cast<char>(id);
}

/// Returns `info` without a wrist, a gripper or motors that the device lacks; an empty name becomes
/// the SDK's.
DeviceInfo fitted(DeviceInfo info, const DhdLibrary& library, char id)
{
    info.name = info.name.empty() ? system_name(library, id) : info.name;
    RotationLimits& turn = info.limits.rotation;
    turn.is_measured = library->dhdHasWrist(id);
    turn.torque_max_nm = library->dhdHasActiveWrist(id) ? turn.torque_max_nm : 0.0;
    info.gripper_force_max_n = library->dhdHasActiveGripper(id) ? info.gripper_force_max_n : 0.0;
    return info;
}

bool is_usable(const Vec3& v) noexcept
{
    return std::abs(v.x()) <= kGoalRange_m && std::abs(v.y()) <= kGoalRange_m &&
           std::abs(v.z()) <= kGoalRange_m;
}

} // namespace

/// Omega class of platform/devices/simulated/device_classes.hpp with the force and the stiffness of
/// the weakest device, and a delay of one cycle and two transfers. Its wrist is a light one, with a
/// quarter of the torque of the maker's.
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
                   .added_damping_max_n_s_per_m = 10.0,
                   .rotation = {.is_measured = true,
                                .torque_max_nm = 0.1,
                                .inertia_kg_m2 = 1e-4,
                                .damping_nm_s_per_rad = 5e-4,
                                .friction_nm = 0.0,
                                .quantum_rad = 2e-4,
                                .slew_max_nm_per_s = 200.0,
                                .stiffness_max_nm_per_rad = 0.4,
                                .added_damping_max_nm_s_per_rad = 3e-3}};
    info.gripper_force_max_n = 4.0;
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
    const DeviceInfo info = fitted(options.info, library.value(), id.value());
    std::unique_ptr<DhdDevice> device(
        // The DhdDevice closes the SDK's device.
        new DhdDevice(std::move(library).value(), id.value(), info, options));
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
    , has_wrist_(library_->dhdHasWrist(id))
    , has_gripper_(library_->dhdHasGripper(id))
    , period_(options.period)
    , watchdog_steps_(watchdog_steps(options.times.force_hold))
    , id_(id)
{
}

DhdDevice::~DhdDevice()
{
    is_stopped_.store(true);
    thread_.reset();
    if (is_open_)
    {
        static_cast<void>(set_force({}));
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

/// Runs one cycle; false if the device doesn't answer.
bool DhdDevice::turn() noexcept
{
    return publish_reading() && obey(command());
}

/// Publishes a reading; false if the device doesn't answer. A non-finite position is the SDK's
/// failure and makes the reading invalid. A velocity that can't be read stays empty.
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
    reading.buttons = library_->dhdGetButtonMask(id_);
    read_wrist_and_gripper(reading);
    publish(reading, std::exchange(is_new_, false));
    return true;
}

/// Reads wrist and gripper into `reading`. A wrist without a valid rotation makes the reading
/// invalid.
void DhdDevice::read_wrist_and_gripper(DeviceReading& reading) const noexcept
{
    if (has_wrist_)
    {
        double rows[3][3] = {};
        const bool is_read = library_->dhdGetOrientationFrame(rows, id_) >= 0;
        Mat3 frame;
        frame << rows[0][0], rows[0][1], rows[0][2], rows[1][0], rows[1][1], rows[1][2], rows[2][0],
            rows[2][1], rows[2][2];
        const bool is_good = is_read && is_rotation(frame, kFrameTolerance);
        reading.valid = reading.valid && is_good;
        reading.rotation =
            is_good ? std::optional(to_quaternion(orthonormalised(frame))) : std::nullopt;
        Vec3 turning(0.0, 0.0, 0.0);
        if (library_->dhdGetAngularVelocityRad(&turning.x(), &turning.y(), &turning.z(), id_) >=
                0 &&
            is_usable(turning))
        {
            reading.angular_velocity_rad_per_s = turning;
        }
    }
    double gap_m = 0.0;
    if (has_gripper_ && library_->dhdGetGripperGap(&gap_m, id_) >= 0 && std::isfinite(gap_m))
    {
        reading.gripper_m = gap_m;
    }
}

/// True if the deadman button is pressed, or if none is chosen. A button that can't be read counts
/// as released.
bool DhdDevice::is_held() const noexcept
{
    return !deadman_button_ || library_->dhdGetButton(*deadman_button_, id_) == 1;
}

/// Applies a command; false if the device doesn't obey. Not every device has brakes, so zero force
/// alone is a successful brake.
bool DhdDevice::obey(const DeviceCommand& command) noexcept
{
    const DhdFunctions& sdk = *library_;
    const MonotonicTime now = clock().now();
    // The device's watchdog may have disabled the forces meanwhile.
    makes_forces_ = makes_forces_ && now - obeyed_ < kWatchdogStep * watchdog_steps_;
    obeyed_ = now;
    bool is_done = true;
    if (command.state == DeviceState::brake)
    {
        const bool is_free = set_force({});
        const bool is_braked = sdk.dhdSetBrakes(1, id_) >= 0;
        is_done = is_free || is_braked;
    }
    else
    {
        if (!makes_forces_)
        {
            static_cast<void>(sdk.dhdSetBrakes(0, id_));
            is_done = sdk.dhdEnableForce(1, id_) >= 0;
            if (sdk.dhdSetWatchdog != nullptr)
            {
                sdk.dhdSetWatchdog(watchdog_steps_, id_); // Devices without a watchdog refuse.
            }
        }
        is_done = is_done && set_force(command);
    }
    makes_forces_ = is_done && command.state != DeviceState::brake;
    return is_done;
}

bool DhdDevice::set_force(const DeviceCommand& command) const noexcept
{
    const Vec3& force_n = command.force_n;
    const Vec3& torque_nm = command.torque_nm;
    return library_->dhdSetForceAndTorqueAndGripperForce(
               force_n.x(), force_n.y(), force_n.z(), torque_nm.x(), torque_nm.y(), torque_nm.z(),
               command.gripper_force_n, id_) >= 0;
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
