// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/udp/datagram.hpp"
#include "tests/unit/platform/example_datagrams.hpp"
#include "tests/unit/rt_core/coded_bytes.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace tactus::udp
{
namespace
{

using Bytes = std::vector<std::byte>;

Bytes to_bytes(const Datagram& datagram)
{
    return {datagram.begin(), datagram.end()};
}

/// Datagram of a device of version 1, or an answer to it.
template <typename Datagram>
Datagram of_points(Datagram datagram)
{
    datagram.version = kVersionOfPoints;
    return datagram;
}

template <typename T>
T value_at(const Bytes& bytes, std::size_t at)
{
    T value{};
    std::memcpy(&value, bytes.data() + at, sizeof(T));
    return value;
}

/// Datagram with another value and a valid checksum, so that the value is checked.
template <typename T>
Bytes with(Bytes bytes, std::size_t at, const T& value)
{
    std::memcpy(bytes.data() + at, &value, sizeof(T));
    const std::uint32_t crc = test::bitwise_crc32c(std::span(bytes).first(bytes.size() - 4));
    std::memcpy(bytes.data() + bytes.size() - 4, &crc, sizeof(crc));
    return bytes;
}

template <typename T>
using Places = std::vector<std::pair<std::size_t, T>>;

/// Expects the size, the start, the checksum at the end, and numbers at places.
void expect_bytes(const Datagram& datagram, std::size_t size, const char* head,
                  const Places<double>& numbers, const Places<std::uint64_t>& words,
                  const Places<std::uint32_t>& flags)
{
    const Bytes bytes = to_bytes(datagram);
    ASSERT_EQ(bytes.size(), size);
    EXPECT_EQ(std::memcmp(bytes.data(), head, 8), 0) << head;
    EXPECT_EQ(value_at<std::uint32_t>(bytes, size - 4),
              test::bitwise_crc32c(std::span(bytes).first(size - 4)));
    for (const auto& [at, number] : numbers)
    {
        EXPECT_EQ(value_at<double>(bytes, at), number) << head << at;
    }
    for (const auto& [at, word] : words)
    {
        EXPECT_EQ(value_at<std::uint64_t>(bytes, at), word) << head << at;
    }
    for (const auto& [at, flag] : flags)
    {
        EXPECT_EQ(value_at<std::uint32_t>(bytes, at), flag) << head << at;
    }
}

DatagramFault refusal_of(const Bytes& bytes)
{
    const FromDevice decoded = decode_from_device(bytes);
    const auto* refusal = std::get_if<DatagramFault>(&decoded);
    return refusal != nullptr ? *refusal : DatagramFault::foreign; // decode() never returns it.
}

DatagramFault force_refusal_of(const Bytes& bytes)
{
    const FromController decoded = decode_from_controller(bytes);
    const auto* refusal = std::get_if<DatagramFault>(&decoded);
    return refusal != nullptr ? *refusal : DatagramFault::foreign;
}

TEST(UdpDatagram, has_the_bytes_of_the_page)
{
    Places<double> numbers{{64, 0.1}};
    for (std::size_t i = 0; i < 9; ++i)
    {
        numbers.emplace_back(192 + 8 * i, 17.0 + static_cast<double>(i));
    }
    expect_bytes(encode(test::example_description()), 288, "TCTD\2\0\1\0", numbers,
                 {{184, 16}, {264, 0}, {272, 0}}, {{280, 1}});
    expect_bytes(encode(test::example_sample()), 180, "TCTD\2\0\2\0",
                 {{48, 0.3}, {72, -3.0}, {88, 0.6}, {112, 0.8}, {136, -6.0}, {144, 0.04}},
                 {{80, 1'234'567}, {152, 0}, {160, 0}},
                 {{168, 0x8000'0001U}, {172, 1U | 2U | 8U | 16U | 32U}});
    expect_bytes(encode(test::example_force()), 120, "TCTD\2\0\3\0",
                 {{48, 3.5}, {72, 0.3}, {80, -0.4}}, {{88, 5}, {96, 0}, {104, 0}}, {{112, 2}});
}

/// Later versions will use the tag; a receiver that cannot check it ignores it.
TEST(UdpDatagram, is_taken_whatever_its_tag)
{
    const Bytes sample = to_bytes(encode(test::example_sample()));
    const auto decoded = decode_from_device(with(sample, 155, std::uint64_t{0x1234}));
    ASSERT_TRUE(std::holds_alternative<SampleDatagram>(decoded));
    const auto& got = std::get<SampleDatagram>(decoded);
    EXPECT_EQ(got.rotation, test::example_sample().rotation);
    EXPECT_EQ(got.angular_velocity_rad_per_s, test::example_sample().angular_velocity_rad_per_s);
    EXPECT_EQ(got.gripper_m, 0.04);
    EXPECT_EQ(got.buttons, 0x8000'0001U);
    EXPECT_EQ(got.tag[3], std::byte{0x34});
}

/// Device without rotation, as of version 1.
TEST(UdpDatagram, of_version_1_is_still_understood)
{
    const auto described = decode_from_device(encode(of_points(test::example_description())));
    ASSERT_TRUE(std::holds_alternative<DescribeDatagram>(described));
    const auto& device = std::get<DescribeDatagram>(described);
    EXPECT_EQ(device.version, 1);
    EXPECT_EQ(device.info.limits.added_damping_max_n_s_per_m, 9.0);
    EXPECT_EQ(device.info.limits.rotation, RotationLimits{});
    EXPECT_EQ(device.info.gripper_force_max_n, 0.0);
    const auto sampled = decode_from_device(encode(of_points(test::example_sample())));
    ASSERT_TRUE(std::holds_alternative<SampleDatagram>(sampled));
    const auto& sample = std::get<SampleDatagram>(sampled);
    EXPECT_EQ(sample.position_m, test::example_sample().position_m);
    EXPECT_EQ(sample.rotation, std::nullopt);
    EXPECT_EQ(sample.gripper_m, std::nullopt);
    EXPECT_EQ(sample.buttons, 0U);
}

TEST(UdpDatagram, of_version_1_has_its_bytes_of_the_page)
{
    const Datagram described = encode(of_points(test::example_description()));
    expect_bytes(described, 200, "TCTD\1\0\1\0", {{64, 0.1}, {128, 9.0}, {152, 12.0}, {168, 14.0}},
                 {{8, 3}, {16, 0}, {24, 1}, {184, 16}}, {});
    EXPECT_EQ(std::memcmp(to_bytes(described).data() + 32, "desk 1\0", 7), 0);
    expect_bytes(encode(of_points(test::example_sample())), 96, "TCTD\1\0\2\0",
                 {{48, 0.3}, {72, -3.0}}, {{80, 1'234'567}}, {{88, 3}});
    expect_bytes(encode(of_points(test::example_force())), 72, "TCTD\1\0\3\0", {{48, 3.5}},
                 {{56, 5}}, {{64, 2}});
}

TEST(UdpDatagram, says_what_is_wrong)
{
    const Bytes sample = to_bytes(encode(test::example_sample()));
    EXPECT_EQ(refusal_of(with(sample, 0, std::uint32_t{0})), DatagramFault::magic);
    EXPECT_EQ(refusal_of(with(sample, 4, std::uint16_t{0})), DatagramFault::version);
    EXPECT_EQ(refusal_of(with(sample, 4, std::uint16_t{3})), DatagramFault::version);
    EXPECT_EQ(refusal_of(with(sample, 4, std::uint16_t{1})), DatagramFault::size);
    EXPECT_EQ(refusal_of(with(sample, 6, std::uint16_t{0})), DatagramFault::kind);
    EXPECT_EQ(refusal_of(with(sample, 6, std::uint16_t{4})), DatagramFault::kind);
    EXPECT_EQ(refusal_of(with(sample, 6, std::uint16_t{1})), DatagramFault::size);
    EXPECT_EQ(refusal_of(to_bytes(encode(test::example_force()))), DatagramFault::kind);
    EXPECT_EQ(force_refusal_of(sample), DatagramFault::kind);
    Bytes noisy = sample;
    noisy[40] ^= std::byte{16};
    EXPECT_EQ(refusal_of(noisy), DatagramFault::checksum);
}

TEST(UdpDatagram, names_the_value_for_which_it_is_refused)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Bytes sample = to_bytes(encode(test::example_sample()));
    const Bytes described = to_bytes(encode(test::example_description()));
    const auto wrong_in = [](const Bytes& bytes)
    {
        const char* wrong = nullptr;
        static_cast<void>(decode_from_device(bytes, &wrong));
        return std::string(wrong != nullptr ? wrong : "");
    };
    EXPECT_EQ(wrong_in(sample), "");
    EXPECT_EQ(wrong_in(described), "");
    EXPECT_EQ(wrong_in(with(sample, 32, nan)), "position");
    EXPECT_EQ(wrong_in(with(sample, 56, nan)), "velocity");
    EXPECT_EQ(wrong_in(with(sample, 80, std::int64_t{-1})), "time");
    EXPECT_EQ(wrong_in(with(sample, 88, 0.600'01)),
              "rotation, whose length is not within 1e-6 of 1");
    EXPECT_EQ(wrong_in(with(sample, 120, nan)), "angular velocity");
    EXPECT_EQ(wrong_in(with(sample, 144, nan)), "gripper");
    EXPECT_EQ(wrong_in(with(sample, 172, std::uint32_t{64 | 1})), "flags");
    EXPECT_EQ(wrong_in(with(sample, 24, std::uint64_t{0})), "address");
    EXPECT_EQ(wrong_in(with(described, 60, 'x')), "name");
    EXPECT_EQ(wrong_in(with(described, 64, nan)).rfind("device: mass_kg", 0), 0U);
}

TEST(UdpDatagram, is_refused_for_values_out_of_range)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinite = std::numeric_limits<double>::infinity();
    const Bytes sample = to_bytes(encode(test::example_sample()));
    EXPECT_EQ(refusal_of(with(sample, 8, std::uint64_t{0})), DatagramFault::content) << "instance";
    EXPECT_EQ(refusal_of(with(sample, 24, std::uint64_t{0})), DatagramFault::content) << "sequence";
    for (std::size_t at = 32; at < 80; at += 8)
    {
        for (const double bad : {nan, infinite, -infinite, 1.000'001e6, -1.000'001e6})
        {
            EXPECT_EQ(refusal_of(with(sample, at, bad)), DatagramFault::content)
                << at << ": " << bad;
        }
        EXPECT_EQ(refusal_of(with(sample, at, 1e6)), DatagramFault::foreign) << "is taken";
    }
    EXPECT_EQ(refusal_of(with(sample, 80, std::int64_t{-1})), DatagramFault::content);
    EXPECT_EQ(refusal_of(with(sample, 80, (std::int64_t{1} << 62) + 1)), DatagramFault::content);
    EXPECT_EQ(refusal_of(with(sample, 172, std::uint32_t{64 | 1})), DatagramFault::content);
    for (std::size_t at = 120; at < 152; at += 8)
    {
        for (const double bad : {nan, infinite, -infinite, 1.000'001e6})
        {
            EXPECT_EQ(refusal_of(with(sample, at, bad)), DatagramFault::content) << at;
        }
    }
    for (const double bad : {nan, infinite, 0.0, 0.600'01})
    {
        EXPECT_EQ(refusal_of(with(sample, 88, bad)), DatagramFault::content) << "no unit " << bad;
    }
    const Bytes of_a_point = to_bytes(encode(of_points(test::example_sample())));
    EXPECT_EQ(refusal_of(with(of_a_point, 88, std::uint32_t{8 | 1})), DatagramFault::content);

    const Bytes described = to_bytes(encode(test::example_description()));
    EXPECT_EQ(refusal_of(with(described, 16, std::uint64_t{1})), DatagramFault::content)
        << "session";
    EXPECT_EQ(refusal_of(with(described, 280, std::uint32_t{2})), DatagramFault::content)
        << "reserved";
    EXPECT_EQ(refusal_of(with(described, 280, std::uint32_t{0})), DatagramFault::content)
        << "a torque without a rotation";
    const Bytes point = to_bytes(encode(of_points(test::example_description())));
    EXPECT_EQ(refusal_of(with(point, 192, std::uint32_t{1})), DatagramFault::content) << "reserved";
    for (std::size_t at = 192; at < 264; at += 8)
    {
        for (const double bad : {nan, infinite, -1.0})
        {
            EXPECT_EQ(refusal_of(with(described, at, bad)), DatagramFault::content) << at;
        }
    }
    EXPECT_EQ(refusal_of(with(described, 60, 'x')), DatagramFault::content) << "behind the name";
    EXPECT_EQ(refusal_of(with(described, 32, std::array<char, 32>{})), DatagramFault::content);
    for (std::size_t at = 64; at < 176; at += 8)
    {
        EXPECT_EQ(refusal_of(with(described, at, nan)), DatagramFault::content) << at;
        EXPECT_EQ(refusal_of(with(described, at, infinite)), DatagramFault::content) << at;
    }
    EXPECT_EQ(refusal_of(with(described, 176, std::int64_t{0})), DatagramFault::content);
    EXPECT_EQ(refusal_of(with(described, 184, std::int64_t{14})), DatagramFault::content);

    const Bytes force = to_bytes(encode(test::example_force()));
    EXPECT_EQ(force_refusal_of(with(force, 32, nan)), DatagramFault::content);
    EXPECT_EQ(force_refusal_of(with(force, 64, nan)), DatagramFault::content) << "torque";
    EXPECT_EQ(force_refusal_of(with(force, 80, infinite)), DatagramFault::content) << "gripper";
    EXPECT_EQ(force_refusal_of(with(force, 112, std::uint32_t{3})), DatagramFault::content);
}

/// A device without a position must be able to say so with any values in its variables.
TEST(UdpDatagram, looks_at_no_position_that_is_said_to_be_invalid)
{
    SampleDatagram lost = test::example_sample();
    lost.valid = false;
    lost.position_m[1] = std::numeric_limits<double>::quiet_NaN();
    const auto decoded = decode_from_device(encode(lost));
    ASSERT_TRUE(std::holds_alternative<SampleDatagram>(decoded));
    const auto& sample = std::get<SampleDatagram>(decoded);
    EXPECT_FALSE(sample.valid);
    EXPECT_EQ(sample.position_m, (std::array{0.0, 0.0, 0.0}));
    EXPECT_FALSE(sample.velocity_m_per_s);
}

TEST(UdpDatagram, has_a_text_for_each_refusal)
{
    for (std::size_t i = 0; i < kDatagramFaults; ++i)
    {
        EXPECT_FALSE(text_of(static_cast<DatagramFault>(i)).empty());
    }
}

} // namespace
} // namespace tactus::udp
