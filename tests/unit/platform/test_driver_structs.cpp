// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/platform/example_datagrams.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <tactus_driver.h>
#include <variant>
#include <vector>

namespace tactus::udp
{
namespace
{

constexpr std::int64_t kMs = 1'000'000;

/// Example's description, in the struct for drivers.
tactus_describe described()
{
    const DeviceInfo info = tactus::test::example_description().info;
    tactus_describe describe{};
    std::ranges::copy(info.name, describe.name);
    describe.mass_kg = info.limits.mass_kg;
    describe.damping_n_s_per_m = info.limits.damping_n_s_per_m;
    describe.friction_n = info.limits.friction_n;
    describe.position_step_m = info.limits.quantum_m;
    describe.delay_s = info.limits.delay_s;
    describe.force_max_n = info.limits.force_max_n;
    describe.force_growth_max_n_per_s = info.limits.slew_max_n_per_s;
    describe.stiffness_max_n_per_m = info.limits.stiffness_max_n_per_m;
    describe.added_damping_max_n_s_per_m = info.limits.added_damping_max_n_s_per_m;
    std::ranges::copy(info.workspace_centre_world_m, describe.workspace_centre_m);
    describe.workspace_radius_m = info.workspace_radius_m;
    describe.speed_max_m_per_s = info.speed_max_m_per_s;
    describe.rate_min_hz = info.rate_min_hz;
    describe.rate_max_hz = info.rate_max_hz;
    describe.torque_max_nm = info.limits.rotation.torque_max_nm;
    describe.inertia_kg_m2 = info.limits.rotation.inertia_kg_m2;
    describe.rotational_damping_nm_s_per_rad = info.limits.rotation.damping_nm_s_per_rad;
    describe.rotational_friction_nm = info.limits.rotation.friction_nm;
    describe.rotation_step_rad = info.limits.rotation.quantum_rad;
    describe.torque_growth_max_nm_per_s = info.limits.rotation.slew_max_nm_per_s;
    describe.rotational_stiffness_max_nm_per_rad = info.limits.rotation.stiffness_max_nm_per_rad;
    describe.added_rotational_damping_max_nm_s_per_rad =
        info.limits.rotation.added_damping_max_nm_s_per_rad;
    describe.gripper_force_max_n = info.gripper_force_max_n;
    describe.flags = TACTUS_MEASURES_ROTATION;
    return describe;
}

/// Example's sample, in the struct for drivers.
tactus_sample sampled()
{
    const SampleDatagram example = tactus::test::example_sample();
    tactus_sample sample{};
    std::ranges::copy(example.position_m, sample.position_m);
    std::ranges::copy(*example.velocity_m_per_s, sample.velocity_m_per_s);
    sample.time_ns = example.time_ns;
    std::ranges::copy(*example.rotation, sample.rotation);
    std::ranges::copy(*example.angular_velocity_rad_per_s, sample.angular_velocity_rad_per_s);
    sample.gripper_m = *example.gripper_m;
    sample.buttons = example.buttons;
    sample.flags = TACTUS_VALID | TACTUS_HAS_VELOCITY | TACTUS_HAS_ROTATION |
                   TACTUS_HAS_ANGULAR_VELOCITY | TACTUS_HAS_GRIPPER;
    return sample;
}

/// Driver that began at second 1, and the controller's side.
struct DriverStructs : ::testing::Test
{
    DriverStructs()
    {
        driver.describe = described();
        tactus_driver_start(&driver, 3, now_ns);
    }
    /// Bytes sent now; empty: none.
    std::span<const std::byte> next()
    {
        std::size_t size = 0;
        const void* bytes = tactus_driver_next(&driver, &sample, now_ns, &size);
        return {static_cast<const std::byte*>(bytes), bytes != nullptr ? size : 0};
    }
    bool takes(const ForceDatagram& sent)
    {
        const Datagram datagram = encode(sent);
        return tactus_driver_take(&driver, datagram.data(), datagram.size(), now_ns) != 0;
    }

    std::int64_t now_ns{1'000 * kMs};
    tactus_driver driver{};
    tactus_sample sample = sampled();
    ForceDatagram force = tactus::test::example_force();
};

TEST_F(DriverStructs, say_what_the_controller_reads)
{
    const FromDevice told = decode_from_device(next());
    ASSERT_TRUE(std::holds_alternative<DescribeDatagram>(told));
    const auto& describe = std::get<DescribeDatagram>(told);
    const DescribeDatagram example = tactus::test::example_description();
    EXPECT_EQ(describe.address.instance, 3U);
    EXPECT_EQ(describe.address.session, 0U);
    EXPECT_EQ(describe.address.sequence, 1U);
    EXPECT_EQ(describe.info, example.info);

    ASSERT_TRUE(takes(force));
    const FromDevice read = decode_from_device(next());
    ASSERT_TRUE(std::holds_alternative<SampleDatagram>(read));
    SampleDatagram expected = tactus::test::example_sample();
    expected.address = {3, force.address.session, 2};
    const Datagram bytes = encode(expected);
    const Datagram same = encode(std::get<SampleDatagram>(read));
    EXPECT_TRUE(std::ranges::equal(bytes, same));
}

TEST_F(DriverStructs, read_what_the_controller_says)
{
    ASSERT_TRUE(takes(force));
    EXPECT_TRUE(std::ranges::equal(driver.force.force_n, force.force_n));
    EXPECT_TRUE(std::ranges::equal(driver.force.torque_nm, force.torque_nm));
    EXPECT_EQ(driver.force.gripper_n, force.gripper_force_n);
    EXPECT_EQ(driver.force.state, static_cast<std::uint32_t>(TACTUS_BRAKE));
    EXPECT_FALSE(takes(force)) << "twice";
    --force.address.sequence;
    EXPECT_FALSE(takes(force)) << "an older one";
    force.address.sequence += 2;
    force.address.instance = 4;
    EXPECT_FALSE(takes(force)) << "another driver's";
    force.address.instance = 3;
    Datagram datagram = encode(force);
    auto bytes = std::vector<std::byte>(datagram.begin(), datagram.end());
    bytes[40] ^= std::byte{1};
    EXPECT_EQ(tactus_driver_take(&driver, bytes.data(), bytes.size(), now_ns), 0) << "damaged";
    EXPECT_EQ(tactus_driver_take(&driver, datagram.data(), 119, now_ns), 0) << "cut";
    EXPECT_TRUE(takes(force));
}

TEST_F(DriverStructs, take_the_force_away_when_the_controller_is_silent_and_begin_again)
{
    EXPECT_FALSE(next().empty());
    EXPECT_TRUE(next().empty()) << "it describes itself every 100 ms";
    now_ns += 100 * kMs;
    EXPECT_FALSE(next().empty());
    ASSERT_TRUE(takes(force));
    now_ns += 20 * kMs;
    EXPECT_EQ(next().size(), sizeof(tactus_sample));
    EXPECT_EQ(driver.force.force_n[0], force.force_n[0]);
    now_ns += 1;
    EXPECT_EQ(next().size(), sizeof(tactus_sample));
    EXPECT_EQ(driver.force.force_n[0], 0.0);
    EXPECT_EQ(driver.force.state, static_cast<std::uint32_t>(TACTUS_IDLE));
    EXPECT_FALSE(takes(force)) << "the session goes on, and so does its sequence";
    now_ns += 80 * kMs;
    EXPECT_EQ(next().size(), sizeof(tactus_describe));
    EXPECT_TRUE(takes(force)) << "of a controller that has begun again";
}

/// Tag other than BLAKE2b: it shows the authenticated bytes, and that the tag matters.
void sum(const void* bytes, std::size_t size, std::uint8_t tag[16])
{
    const auto* at = static_cast<const std::uint8_t*>(bytes);
    std::fill_n(tag, 16, std::uint8_t{7});
    for (std::size_t i = 0; i < size; ++i)
    {
        tag[i % 16] = static_cast<std::uint8_t>(tag[i % 16] * 31 + at[i]);
    }
}

struct SumAuthenticator final : Authenticator
{
    [[nodiscard]] Tag tag_of(std::span<const std::byte> bytes) const noexcept override
    {
        std::uint8_t tag[16];
        sum(bytes.data(), bytes.size(), tag);
        Tag result{};
        std::memcpy(result.data(), tag, sizeof(tag));
        return result;
    }
};

TEST_F(DriverStructs, are_sealed_by_a_key_both_ways)
{
    const SumAuthenticator authenticator;
    driver.authenticate = sum;
    EXPECT_TRUE(is_authentic(next(), authenticator));
    EXPECT_FALSE(takes(force));
    const Datagram datagram = authenticated(encode(force), authenticator);
    ASSERT_EQ(tactus_driver_take(&driver, datagram.data(), datagram.size(), now_ns), 1);
    EXPECT_TRUE(is_authentic(next(), authenticator));
}

} // namespace
} // namespace tactus::udp
