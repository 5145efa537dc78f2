// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/udp/session.hpp"

#include "platform/devices/device_force.hpp"

#include <algorithm>
#include <utility>

namespace tactus::udp
{

std::variant<Described, Sampled, DatagramFault>
Session::receive(std::span<const std::byte> bytes, const Endpoint& from, MonotonicTime now)
{
    const FromDevice datagram = decode_from_device(bytes);
    if (authenticator_ != nullptr && !std::holds_alternative<DatagramFault>(datagram) &&
        !is_authentic(bytes, *authenticator_))
    {
        return DatagramFault::tag;
    }
    if (const auto* described = std::get_if<DescribeDatagram>(&datagram))
    {
        return describe(*described, from, now);
    }
    if (const auto* sampled = std::get_if<SampleDatagram>(&datagram))
    {
        return sample(*sampled, from, now);
    }
    return std::get<DatagramFault>(datagram);
}

/// Handles a description. A repeated one is no fault: a device repeats it until it is answered.
std::variant<Described, Sampled, DatagramFault>
Session::describe(const DescribeDatagram& datagram, const Endpoint& from, MonotonicTime now)
{
    const Address& address = datagram.address;
    const bool is_known = from == peer_.endpoint && address.instance == peer_.instance;
    if (is_taken(now) && !is_known)
    {
        rival_ = is_settled_ ? rival_ : Rival{from, now};
        return DatagramFault::foreign;
    }
    if (address.instance == peer_.instance && address.sequence <= last_sequence_)
    {
        return DatagramFault::stale;
    }
    const bool is_fixed = is_settled_ || peer_.is_attached;
    if (is_fixed && info_ && *info_ != datagram.info)
    {
        return DatagramFault::other_device;
    }
    if (!peer_.is_attached)
    {
        info_ = datagram.info;
        begin({from, address.instance, next_, true, datagram.version}, now);
        next_ = std::max<std::uint64_t>(next_ + 1, 1); // 0 means no session.
    }
    last_sequence_ = address.sequence;
    return Described{};
}

/// True if a device is attached, or a silent one keeps its place.
bool Session::is_taken(MonotonicTime now) const noexcept
{
    return peer_.is_attached || (is_settled_ && last_time_ns_ >= 0 && now - heard_ <= place_);
}

bool Session::is_proven(Duration time, MonotonicTime now) const noexcept
{
    const bool is_alone = !rival_ || now - rival_->heard > kRivalry;
    return peer_.is_attached && samples_ >= kProof && now - begun_ >= time && is_alone;
}

void Session::begin(const Peer& peer, MonotonicTime now) noexcept
{
    peer_ = peer;
    heard_ = begun_ = now;
    samples_ = 0;
    has_samples_ = false;
    last_time_ns_ = -1;
}

std::variant<Described, Sampled, DatagramFault>
Session::sample(const SampleDatagram& datagram, const Endpoint& from, MonotonicTime now) noexcept
{
    const Address& address = datagram.address;
    if (from != peer_.endpoint || address.instance != peer_.instance)
    {
        return DatagramFault::foreign;
    }
    if (address.session != peer_.session)
    {
        return DatagramFault::session;
    }
    if (address.sequence <= last_sequence_ || datagram.time_ns <= last_time_ns_)
    {
        return DatagramFault::stale;
    }
    Sampled sampled;
    sampled.is_new = !std::exchange(has_samples_, true);
    sampled.reading.arrival = now;
    sampled.reading.time = on_our_clock(datagram.time_ns, now);
    sampled.reading.valid = datagram.valid;
    sampled.reading.deadman_held = datagram.deadman_held;
    sampled.reading.buttons = datagram.buttons;
    sampled.reading.gripper_m = datagram.gripper_m;
    sampled.reading.position_m = to_vec3(datagram.position_m);
    sampled.reading.rotation = datagram.rotation;
    if (datagram.velocity_m_per_s)
    {
        sampled.reading.velocity_m_per_s = to_vec3(*datagram.velocity_m_per_s);
    }
    if (datagram.angular_velocity_rad_per_s)
    {
        sampled.reading.angular_velocity_rad_per_s = to_vec3(*datagram.angular_velocity_rad_per_s);
    }
    last_sequence_ = address.sequence;
    heard_ = now;
    samples_ = std::min(samples_ + 1, kProof);
    peer_.is_attached = true;
    return sampled;
}

/// Converts a device time to the controller's clock by an offset. The offset is set at the first
/// sample and after a drift only, so the network's jitter doesn't disturb the intervals. Always
/// increases.
MonotonicTime Session::on_our_clock(std::int64_t time_ns, MonotonicTime now) noexcept
{
    const bool is_first = last_time_ns_ < 0;
    last_time_ns_ = time_ns;
    MonotonicTime time{time_ns + clock_offset_ns_};
    if (is_first || time > now + kClockDrift || time < now - kClockDrift || time <= last_time_)
    {
        time = std::max(now, last_time_ + nanoseconds(1));
        clock_offset_ns_ = time.ns - time_ns;
    }
    last_time_ = time;
    return time;
}

bool Session::lapse(MonotonicTime now) noexcept
{
    if (!peer_.is_attached || now - heard_ <= silence_)
    {
        return false;
    }
    peer_.is_attached = false;
    has_samples_ = false;
    return true;
}

} // namespace tactus::udp
