// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/choices/recorded_motion.hpp"

#include "platform/choices/messages.hpp"
#include "platform/devices/device_force.hpp"
#include "platform/devices/simulated/device_classes.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/rotation.hpp"

#include <array>
#include <cmath>
#include <optional>

namespace tactus::hrtc
{

namespace
{

std::optional<std::array<double, 3>> to_array(const std::optional<Vec3>& v)
{
    return v ? std::optional(tactus::to_array(*v)) : std::nullopt;
}

/// Sample as the device reported it; without a rotation if the device measured none.
DeviceSample reading_of(const ToolState& state, const DeviceRecord& device)
{
    const DevicePose pose = device.pose.value_or(DevicePose{state.position_m, state.rotation});
    DeviceSample reading;
    reading.position_world_m = tactus::to_array(pose.position_m);
    reading.velocity_world_m_per_s = to_array(device.velocity_m_per_s);
    reading.time = MonotonicTime{state.sample_time_ns};
    reading.connected = device.connected;
    reading.valid = state.valid;
    reading.deadman_held = device.deadman_held;
    if (device.measures_rotation)
    {
        const bool is_sound = is_rotation(pose.rotation, kRotationTolerance);
        reading.rotation_world =
            is_sound ? to_quaternion(orthonormalised(pose.rotation)) : Quaternion{};
    }
    reading.angular_velocity_world_rad_per_s = to_array(device.angular_velocity_rad_per_s);
    reading.buttons = device.buttons;
    reading.gripper_m = device.gripper_m;
    return reading;
}

} // namespace

Result<ReplayDeviceOptions, Refusal> read_recorded_motion(const std::string& path, std::size_t tool)
{
    const auto recording = Recording::read(path);
    if (!recording)
    {
        return recording.error();
    }
    if (const std::string missing = recording.value().missing(); !missing.empty())
    {
        log_line(path + ": " + missing);
    }
    const RecordedSetup& setup = recording.value().setup();
    const std::size_t played = tool < setup.tools.size() ? tool : 0;
    ReplayDeviceOptions options;
    options.rate_hz = std::llround(1e9 / static_cast<double>(setup.period_ns));
    options.limits.force_max_n = setup.tools[played].force_max_n;
    options.limits.rotation = kDeskRotation;
    options.limits.rotation.torque_max_nm = setup.tools[played].torque_max_nm;
    options.readings.reserve(recording.value().frame_count());
    FrameDecoder decoder(recording.value().shape());
    for (ByteReader reader(recording.value().frames()); !reader.at_end();)
    {
        const char* fault = decoder.decode(reader);
        TACTUS_ASSERT(fault == nullptr); // The recording was checked as a whole.
        options.readings.push_back(
            reading_of(decoder.frame().tools[played], decoder.frame().devices[played]));
    }
    return options;
}

} // namespace tactus::hrtc
