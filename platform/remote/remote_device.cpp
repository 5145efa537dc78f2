// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/remote/remote_device.hpp"

#include "platform/device_force.hpp"

namespace tactus
{

namespace
{

bool is_in_range(Duration time) noexcept
{
    return time >= RemoteTimes::kMin && time <= RemoteTimes::kMax;
}

} // namespace

RtThreadOptions io_thread_options()
{
    RtThreadOptions options;
    options.priority = 79;
    options.lock_memory = false; // These are for whoever has the haptic thread.
    options.processors_awake = false;
    options.allow_no_rt = true;
    return options;
}

std::string find_bad_time(const RemoteTimes& times)
{
    if (!is_in_range(times.silence) || !is_in_range(times.force_hold))
    {
        return "remote device: the time of silence and that of a force's hold must be in range "
               "1 ms..60 s";
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
    // In vain when there is none yet, or when the I/O thread has stopped in the middle of a write:
    // what we have ages and is then told to be so.
    static_cast<void>(readings_.try_read(reading_));
    connected_ = reading_.attached && clock_.now() - reading_.arrival <= times_.silence;
    DeviceSample sample;
    sample.position_world_m = reading_.position_world_m;
    if (reading_.has_velocity)
    {
        sample.velocity_world_m_per_s = reading_.velocity_world_m_per_s;
    }
    sample.time = reading_.time;
    sample.frame = status_.frames++;
    sample.connected = connected_;
    sample.valid = connected_ && reading_.valid;
    sample.deadman_held = reading_.deadman_held;
    return sample;
}

void RemoteDevice::write(const std::array<double, 3>& force_world_n) noexcept
{
    if (braked_.load())
    {
        return;
    }
    const Vec3 force_n = take_force(force_world_n, info_.limits.force_max_n, status_);
    written_ = {to_array(force_n), clock_.now(), reading_.attachment, releases_.load(),
                DeviceState::force};
    commands_.write(written_);
}

void RemoteDevice::brake() noexcept
{
    braked_.store(true);
}

/// The count makes all forces from before void, even where the I/O thread can't read the mailbox at
/// the moment and goes on with what it has.
void RemoteDevice::release_brake() noexcept
{
    written_ = {};
    releases_.fetch_add(1);
    commands_.write(written_);
    braked_.store(false);
}

DeviceStatus RemoteDevice::status() const noexcept
{
    DeviceStatus status = status_;
    status.state = DeviceState::idle;
    if (braked_.load())
    {
        status.state = DeviceState::brake;
    }
    else if (connected_ && makes_force(written_, reading_.attachment, clock_.now()))
    {
        status.state = DeviceState::force;
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
    published_.deadman_held = reading.deadman_held;
    published_.valid = reading.valid;
    if (reading.valid)
    {
        const Vec3 velocity = reading.velocity_m_per_s.value_or(Vec3(Vec3::Zero()));
        published_.position_world_m = to_array(frame_.position_to_world(reading.position_m));
        published_.velocity_world_m_per_s = to_array(frame_.velocity_to_world(velocity));
        published_.has_velocity = reading.velocity_m_per_s.has_value();
        published_.time = reading.time;
    }
    readings_.write(published_);
}

void RemoteDevice::detach() noexcept
{
    published_.attached = false;
    published_.valid = false;
    readings_.write(published_);
}

DeviceCommand RemoteDevice::command() noexcept
{
    DeviceCommand now;
    if (braked_.load())
    {
        now.state = DeviceState::brake;
        return now;
    }
    // In vain while the haptic thread is stopped in the middle of a write: then the last one ages.
    static_cast<void>(commands_.try_read(taken_));
    now.written = taken_.written;
    if (published_.attached && makes_force(taken_, published_.attachment, clock_.now()))
    {
        const auto& force_n = taken_.force_world_n;
        now.force_n = frame_.force_to_device(Vec3(force_n[0], force_n[1], force_n[2]));
        now.state = DeviceState::force;
    }
    return now;
}

} // namespace tactus
