// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/remote/remote_device.hpp"

#include "platform/devices/device_force.hpp"

namespace tactus
{

namespace
{

bool is_in_range(Duration time) noexcept
{
    return time >= RemoteTimes::kMin && time <= RemoteTimes::kMax;
}

/// Applies `function` to the value, if there is one.
template <typename T, typename Function>
auto mapped(const std::optional<T>& value, const Function& function) noexcept
{
    return value ? std::optional(function(*value)) : std::nullopt;
}

} // namespace

RtThreadOptions io_thread_options()
{
    RtThreadOptions options;
    options.priority = 79;
    options.lock_memory = false; // The haptic thread's owner sets both.
    options.processors_awake = false;
    options.allow_no_rt = true;
    return options;
}

std::string find_bad_time(const RemoteTimes& times)
{
    if (!is_in_range(times.silence) || !is_in_range(times.force_hold))
    {
        return "remote device: the silence time and the hold time of a force must be in range 1 "
               "ms..60 s";
    }
    return {};
}

RemoteDevice::RemoteDevice(const DeviceInfo& device, const DeviceFrame& frame,
                           const RemoteTimes& times, const Clock& clock)
    : info_(frame.to_world(device)), frame_(frame), times_(times), clock_(clock)
{
}

DeviceSample RemoteDevice::read() noexcept
{
    // try_read() fails before the first reading, or while the I/O thread is stopped in the middle
    // of a write. Then the last reading ages until the device is not connected.
    static_cast<void>(readings_.try_read(reading_));
    connected_ = reading_.attached && clock_.now() - reading_.arrival <= times_.silence;
    DeviceSample sample = reading_.sample;
    sample.frame = status_.frames++;
    sample.connected = connected_;
    sample.valid = connected_ && sample.valid;
    return sample;
}

void RemoteDevice::write(const Wrench& wrench) noexcept
{
    if (!brake_.lets_through())
    {
        return;
    }
    written_ = {take_wrench(wrench, info_, status_), clock_.now(), reading_.attachment,
                releases_.load(), DeviceState::force};
    commands_.write(written_);
}

void RemoteDevice::brake() noexcept
{
    brake_.brake(clock_.now());
}

void RemoteDevice::brake_softly() noexcept
{
    brake_.brake_softly(clock_.now());
}

/// Counts a release, which voids all earlier forces. This also holds if the I/O thread can't read
/// the mailbox now and continues with its last command.
void RemoteDevice::release_brake() noexcept
{
    if (brake_.try_yield(clock_.now()))
    {
        return;
    }
    written_ = {};
    releases_.fetch_add(1);
    commands_.write(written_);
    brake_.release();
}

DeviceStatus RemoteDevice::status() const noexcept
{
    DeviceStatus status = status_;
    const MonotonicTime now = clock_.now();
    const bool has_force =
        connected_ && makes_force(written_, reading_.attachment, brake_.before(now));
    status.state = has_force ? DeviceState::force : DeviceState::idle;
    if (brake_.is_on())
    {
        status.state = DeviceState::brake;
        status.force_left = has_force ? brake_.share_at(now) : 0.0;
    }
    return status;
}

bool RemoteDevice::makes_force(const Command& command, std::uint64_t attachment,
                               MonotonicTime now) const noexcept
{
    return command.state == DeviceState::force && command.attachment == attachment &&
           command.release == releases_.load() && now - command.written < times_.force_hold;
}

void RemoteDevice::publish(const DeviceReading& reading, bool is_new) noexcept
{
    published_.attachment += is_new ? 1 : 0;
    published_.attached = true;
    published_.arrival = reading.arrival;
    DeviceSample& sample = published_.sample;
    sample.deadman_held = reading.deadman_held;
    sample.buttons = reading.buttons;
    sample.valid = reading.valid;
    if (reading.valid)
    {
        const auto velocity = [this](const Vec3& v)
        { return to_array(frame_.velocity_to_world(v)); };
        const auto turning = [this](const Vec3& v) { return to_array(frame_.turning_to_world(v)); };
        const auto rotation = [this](const Quaternion& q) { return frame_.rotation_to_world(q); };
        sample.position_world_m = to_array(frame_.position_to_world(reading.position_m));
        sample.rotation_world = mapped(reading.rotation, rotation);
        sample.velocity_world_m_per_s = mapped(reading.velocity_m_per_s, velocity);
        sample.angular_velocity_world_rad_per_s =
            mapped(reading.angular_velocity_rad_per_s, turning);
        sample.gripper_m = reading.gripper_m;
        sample.time = reading.time;
    }
    readings_.write(published_);
}

void RemoteDevice::detach() noexcept
{
    published_.attached = false;
    published_.sample.valid = false;
    readings_.write(published_);
}

DeviceCommand RemoteDevice::command() noexcept
{
    DeviceCommand now;
    const MonotonicTime time = clock_.now();
    const double share = brake_.share_at(time);
    if (share == 0.0)
    {
        now.state = DeviceState::brake;
        return now;
    }
    // try_read() fails while the haptic thread is stopped in the middle of a write. Then the last
    // command ages.
    static_cast<void>(commands_.try_read(taken_));
    now.written = share < 1.0 ? time : taken_.written; // Each command of a fade is new.
    if (published_.attached && makes_force(taken_, published_.attachment, brake_.before(time)))
    {
        const Wrench& wrench = taken_.wrench;
        now.force_n = share * frame_.force_to_device(to_vec3(wrench.force_world_n));
        now.torque_nm = share * frame_.torque_to_device(to_vec3(wrench.torque_world_nm));
        now.gripper_force_n = share * wrench.gripper_force_n;
        now.state = DeviceState::force;
    }
    return now;
}

} // namespace tactus
