// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/udp/session.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::udp
{
namespace
{

constexpr Endpoint kHome{0x7F00'0001, 50'000};
constexpr Endpoint kElsewhere{0x7F00'0001, 50'001};
constexpr std::uint64_t kSecret = 0xABCD'EF01'2345'6789;

struct UdpSession : testing::Test
{
    using Result = std::variant<Described, Sampled, DatagramFault>;

    Result describe(std::uint64_t sequence, std::uint64_t instance = 9, Endpoint from = kHome)
    {
        return sut.receive(encode(DescribeDatagram{{instance, 0, sequence}, info}), from, now);
    }
    Result sample(std::uint64_t sequence, std::uint64_t session = kSecret,
                  std::uint64_t instance = 9, Endpoint from = kHome)
    {
        SampleDatagram datagram;
        datagram.address = {instance, session, sequence};
        datagram.time_ns = device_ns;
        datagram.valid = true;
        device_ns += 1'000'000;
        return sut.receive(encode(datagram), from, now);
    }
    static bool is(const Result& result, DatagramFault refusal)
    {
        const auto* found = std::get_if<DatagramFault>(&result);
        return found != nullptr && *found == refusal;
    }
    static bool is_sampled(const Result& result) { return std::holds_alternative<Sampled>(result); }
    static bool is_described(const Result& result)
    {
        return std::holds_alternative<Described>(result);
    }
    void be_silent()
    {
        now = now + milliseconds(21);
        EXPECT_TRUE(sut.lapse(now));
        EXPECT_FALSE(sut.lapse(now)) << "said once";
    }

    DeviceInfo info = []
    {
        DeviceInfo made;
        made.name = "desk";
        made.workspace_radius_m = 0.1;
        made.speed_max_m_per_s = 1.0;
        made.rate_min_hz = 100;
        made.rate_max_hz = 1'000;
        return made;
    }();
    MonotonicTime now{5'000'000'000};
    std::int64_t device_ns{77};
    Session sut{kSecret, milliseconds(20)};
};

TEST_F(UdpSession, hears_nobody_before_a_description)
{
    EXPECT_TRUE(is(sample(1), DatagramFault::foreign));
    EXPECT_FALSE(sut.peer().is_attached);
    EXPECT_FALSE(sut.info());
    EXPECT_TRUE(is_described(describe(1)));
    EXPECT_TRUE(sut.peer().is_attached);
    EXPECT_EQ(sut.peer().session, kSecret);
    EXPECT_EQ(sut.peer().endpoint, kHome);
    EXPECT_TRUE(is_sampled(sample(2)));
}

TEST_F(UdpSession, is_described_again_without_a_new_session)
{
    EXPECT_TRUE(is_described(describe(1)));
    EXPECT_TRUE(is_described(describe(2)));
    EXPECT_EQ(sut.peer().session, kSecret);
    EXPECT_EQ(sut.answers(), 2U);
}

TEST_F(UdpSession, refuses_what_is_not_newer)
{
    EXPECT_TRUE(is_described(describe(5)));
    EXPECT_TRUE(is_sampled(sample(6)));
    for (const std::uint64_t sequence : {std::uint64_t{6}, std::uint64_t{1}, std::uint64_t{5}})
    {
        EXPECT_TRUE(is(sample(sequence), DatagramFault::stale));
        EXPECT_TRUE(is(describe(sequence), DatagramFault::stale));
    }
    EXPECT_TRUE(is_sampled(sample(900))) << "what was lost doesn't matter";
    EXPECT_EQ(sut.answers(), 900U);
    device_ns -= 1'000'000;
    EXPECT_TRUE(is(sample(901), DatagramFault::stale)) << "the time of the one before";
    EXPECT_EQ(sut.answers(), 900U) << "a refusal changes nothing";
}

TEST_F(UdpSession, refuses_others_while_one_is_attached)
{
    EXPECT_TRUE(is_described(describe(1)));
    EXPECT_TRUE(is(describe(1, 10, kElsewhere), DatagramFault::foreign));
    EXPECT_TRUE(is(describe(2, 9, kElsewhere), DatagramFault::foreign));
    EXPECT_TRUE(is(describe(2, 10, kHome), DatagramFault::foreign));
    EXPECT_TRUE(is(sample(2, kSecret, 9, kElsewhere), DatagramFault::foreign));
    EXPECT_TRUE(is(sample(2, kSecret, 10, kHome), DatagramFault::foreign));
    EXPECT_TRUE(is(sample(2, kSecret + 1), DatagramFault::session));
    EXPECT_TRUE(is(sample(2, 0), DatagramFault::session));
    EXPECT_TRUE(is_sampled(sample(2)));
}

TEST_F(UdpSession, is_new_once_for_each_attachment)
{
    EXPECT_TRUE(is_described(describe(1)));
    EXPECT_TRUE(std::get<Sampled>(sample(2)).is_new);
    EXPECT_FALSE(std::get<Sampled>(sample(3)).is_new);
    now = now + milliseconds(20);
    EXPECT_FALSE(sut.lapse(now)) << "not yet";
    be_silent();
    EXPECT_FALSE(sut.peer().is_attached);
    EXPECT_TRUE(std::get<Sampled>(sample(4)).is_new) << "back within its session";
    EXPECT_TRUE(sut.peer().is_attached);
    EXPECT_EQ(sut.peer().session, kSecret);
}

TEST_F(UdpSession, lets_another_instance_in_when_the_first_is_silent)
{
    EXPECT_TRUE(is_described(describe(1)));
    EXPECT_TRUE(is_sampled(sample(2)));
    be_silent();
    EXPECT_TRUE(is_described(describe(1, 10, kElsewhere)));
    EXPECT_EQ(sut.peer().session, kSecret + 1);
    EXPECT_EQ(sut.peer().endpoint, kElsewhere);
    EXPECT_TRUE(is(sample(3), DatagramFault::foreign)) << "the one before is out";
    EXPECT_TRUE(is(sample(2, kSecret, 10, kElsewhere), DatagramFault::session));
    EXPECT_TRUE(std::get<Sampled>(sample(2, kSecret + 1, 10, kElsewhere)).is_new);
}

/// A driver that restarts gets its place back, despite other attempts meanwhile.
TEST_F(UdpSession, keeps_the_place_of_a_device_that_has_sent_samples)
{
    sut = Session(kSecret, milliseconds(20), milliseconds(3'000));
    EXPECT_TRUE(is_described(describe(1)));
    sut.settle();
    EXPECT_TRUE(is_sampled(sample(2)));
    be_silent();
    EXPECT_TRUE(is(describe(1, 10, kElsewhere), DatagramFault::foreign));
    EXPECT_TRUE(is(describe(1, 10, kHome), DatagramFault::foreign));
    EXPECT_TRUE(std::get<Sampled>(sample(3)).is_new) << "back within its session";
    now = now + milliseconds(3'000);
    EXPECT_TRUE(sut.lapse(now));
    EXPECT_TRUE(is(describe(1, 10, kElsewhere), DatagramFault::foreign)) << "just in time";
    EXPECT_TRUE(is_described(describe(4))) << "the device itself may begin anew";
    be_silent();
    now = now + milliseconds(1);
    EXPECT_TRUE(is_described(describe(1, 10, kElsewhere))) << "a new session, without samples";
    EXPECT_TRUE(is_sampled(sample(2, kSecret + 2, 10, kElsewhere)));
    be_silent();
    now = now + milliseconds(2'980);
    EXPECT_TRUE(is_described(describe(1, 11, kHome))) << "later than that";
}

/// A first device with false data loses its place once it is silent.
TEST_F(UdpSession, forgets_a_device_that_falls_silent_before_it_was_settled_on)
{
    sut = Session(kSecret, milliseconds(20), milliseconds(3'000));
    const DeviceInfo truth = info;
    info.limits.force_max_n = 1'000.0;
    EXPECT_TRUE(is_described(describe(1, 10, kElsewhere)));
    EXPECT_TRUE(is_sampled(sample(2, kSecret, 10, kElsewhere)));
    info = truth;
    EXPECT_TRUE(is(describe(1), DatagramFault::foreign));
    be_silent();
    EXPECT_TRUE(is_described(describe(2)));
    EXPECT_EQ(sut.info()->limits.force_max_n, truth.limits.force_max_n);
    sut.settle();
    be_silent();
    info.limits.force_max_n = 1'000.0;
    EXPECT_TRUE(is(describe(1, 10, kElsewhere), DatagramFault::other_device));
}

TEST_F(UdpSession, believes_a_device_that_samples_for_a_while_and_alone)
{
    constexpr Duration kTime = milliseconds(300);
    const auto go_on = [&](int times)
    {
        for (int i = 0; i < times; ++i)
        {
            now = now + milliseconds(10);
            EXPECT_TRUE(is_sampled(sample(sut.answers() + 1)));
        }
    };
    EXPECT_TRUE(is_described(describe(1)));
    EXPECT_FALSE(sut.is_proven(Duration{}, now)) << "it has only described itself";
    go_on(29);
    EXPECT_FALSE(sut.is_proven(kTime, now)) << "too short";
    go_on(1);
    EXPECT_TRUE(sut.is_proven(kTime, now));
    EXPECT_TRUE(is(describe(1, 10, kElsewhere), DatagramFault::foreign));
    ASSERT_TRUE(sut.rival());
    EXPECT_EQ(sut.rival()->endpoint, kElsewhere);
    EXPECT_FALSE(sut.is_proven(kTime, now)) << "there are two";
    go_on(25);
    EXPECT_FALSE(sut.is_proven(kTime, now));
    go_on(1);
    EXPECT_TRUE(sut.is_proven(kTime, now)) << "the other one has gone";
    be_silent();
    EXPECT_FALSE(sut.is_proven(kTime, now));
}

/// Tag that the test can compute: the sum of the bytes, and a secret.
struct Sum final : Authenticator
{
    explicit Sum(std::uint8_t secret) : secret_(secret) {}
    [[nodiscard]] Tag tag_of(std::span<const std::byte> bytes) const noexcept override
    {
        std::uint8_t sum = secret_;
        for (std::size_t i = 0; i < bytes.size(); ++i)
        {
            sum = static_cast<std::uint8_t>(sum * 31U + std::to_integer<std::uint8_t>(bytes[i]));
        }
        Tag tag{};
        tag.front() = tag.back() = std::byte{sum};
        return tag;
    }

private:
    std::uint8_t secret_;
};

TEST_F(UdpSession, with_a_seal_hears_nobody_without_the_key)
{
    const Sum authenticator(7);
    const Sum other(8);
    sut = Session(kSecret, milliseconds(20), {}, &authenticator);
    const DescribeDatagram described{{9, 0, 1}, info};
    DescribeDatagram old = described;
    old.version = kVersionOfPoints;
    for (const Datagram& bytes :
         {encode(described), authenticated(encode(described), other), encode(old)})
    {
        EXPECT_TRUE(is(sut.receive(bytes, kHome, now), DatagramFault::tag));
        EXPECT_FALSE(sut.info());
    }
    EXPECT_TRUE(
        is_described(sut.receive(authenticated(encode(described), authenticator), kHome, now)));
    SampleDatagram datagram;
    datagram.address = {9, kSecret, 2};
    datagram.time_ns = 1;
    EXPECT_TRUE(is(sut.receive(encode(datagram), kHome, now), DatagramFault::tag));
    EXPECT_TRUE(
        is(sut.receive(authenticated(encode(datagram), other), kHome, now), DatagramFault::tag));
    EXPECT_TRUE(
        is_sampled(sut.receive(authenticated(encode(datagram), authenticator), kHome, now)));
}

/// A change of any byte before the checksum invalidates the tag.
TEST_F(UdpSession, a_seal_covers_every_byte)
{
    const Sum authenticator(7);
    ForceDatagram force;
    force.address = {9, kSecret, 1};
    force.state = DeviceState::force;
    SampleDatagram sampled;
    sampled.address = {9, kSecret, 2};
    for (const Datagram& whole :
         {encode(DescribeDatagram{{9, 0, 1}, info}), encode(sampled), encode(force)})
    {
        const Datagram right = authenticated(whole, authenticator);
        EXPECT_TRUE(is_authentic(right, authenticator));
        std::vector<std::byte> bytes(right.begin(), right.end());
        for (std::size_t i = 0; i + 4 < bytes.size(); ++i)
        {
            if (i == 6 || i == 7)
            {
                continue; // The kind, which is right in any datagram that decodes.
            }
            bytes[i] ^= std::byte{1};
            EXPECT_FALSE(is_authentic(bytes, authenticator)) << i;
            bytes[i] ^= std::byte{1};
        }
    }
}

/// The recording of a session is useless in a later one.
TEST_F(UdpSession, refuses_a_session_that_is_played_again)
{
    EXPECT_TRUE(is_described(describe(1)));
    EXPECT_TRUE(is_sampled(sample(2)));
    EXPECT_TRUE(is_sampled(sample(3)));
    be_silent();
    EXPECT_TRUE(is_described(describe(1, 10)));
    be_silent();
    EXPECT_TRUE(is_described(describe(1))) << "anybody may describe the device";
    EXPECT_TRUE(is(sample(2), DatagramFault::session));
    EXPECT_TRUE(is(sample(3), DatagramFault::session));
    be_silent();
    EXPECT_FALSE(sut.peer().is_attached) << "and is out again";
}

TEST_F(UdpSession, lets_no_other_device_in)
{
    EXPECT_TRUE(is_described(describe(1)));
    sut.settle();
    be_silent();
    info.limits.force_max_n += 1.0;
    EXPECT_TRUE(is(describe(1, 10), DatagramFault::other_device));
    info.limits.force_max_n -= 1.0;
    info.name = "other";
    EXPECT_TRUE(is(describe(1, 10), DatagramFault::other_device));
    info.name = "desk";
    EXPECT_TRUE(is_described(describe(1, 10)));
}

TEST_F(UdpSession, steps_as_the_devices_clock_does_and_starts_as_ours)
{
    EXPECT_TRUE(is_described(describe(1)));
    const MonotonicTime first = std::get<Sampled>(sample(2)).reading.time;
    EXPECT_EQ(first, now);
    now = now + microseconds(1'700); // Late in transit; the device's step is 1 ms.
    const auto second = std::get<Sampled>(sample(3)).reading;
    EXPECT_EQ(second.time - first, milliseconds(1));
    EXPECT_EQ(second.arrival, now);
}

TEST_F(UdpSession, never_goes_back_in_time_whatever_the_devices_clock_does)
{
    EXPECT_TRUE(is_described(describe(1)));
    MonotonicTime last = std::get<Sampled>(sample(2)).reading.time;
    const std::vector<std::int64_t> jumps_ns{1, 3'600'000'000'000, 1, std::int64_t{1} << 61};
    std::uint64_t sequence = 3;
    for (const std::int64_t jump_ns : jumps_ns)
    {
        device_ns += jump_ns;
        now = now + milliseconds(1);
        const auto result = sample(sequence++);
        ASSERT_TRUE(is_sampled(result)) << jump_ns;
        const MonotonicTime time = std::get<Sampled>(result).reading.time;
        EXPECT_GT(time, last);
        EXPECT_LE(time, now + Session::kClockDrift);
        last = time;
    }
    be_silent();
    device_ns = 0; // Restarted.
    EXPECT_TRUE(is_described(describe(1, 10)));
    EXPECT_GT(std::get<Sampled>(sample(2, kSecret + 1, 10)).reading.time, last);
}

TEST_F(UdpSession, changes_nothing_for_rubbish)
{
    EXPECT_TRUE(is_described(describe(1)));
    const std::vector<std::byte> rubbish(96, std::byte{0x5A});
    EXPECT_TRUE(is(sut.receive(rubbish, kHome, now + milliseconds(5)), DatagramFault::magic));
    now = now + milliseconds(20);
    EXPECT_FALSE(sut.lapse(now));
    be_silent();
}

} // namespace
} // namespace tactus::udp
