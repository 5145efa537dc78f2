// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/device_choice.hpp"
#include "platform/simulated/device_classes.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tactus::hrtc::test
{

namespace
{

TEST(DeviceChoice, takes_a_simulated_device_of_each_class)
{
    const auto force_and_mass_of = [](std::string_view text)
    {
        const std::optional<DeviceChoice> choice = parse_device(text);
        EXPECT_TRUE(choice.has_value() && choice->kind == DeviceKind::simulated) << text;
        return std::pair(choice->limits.force_max_n, choice->limits.mass_kg);
    };
    EXPECT_EQ(force_and_mass_of("sim"), std::pair(8.0, 0.1));
    EXPECT_EQ(force_and_mass_of("sim:touch"), std::pair(3.3, 0.045));
    EXPECT_EQ(force_and_mass_of("sim:omega"), std::pair(12.0, 0.2));
    EXPECT_EQ(force_and_mass_of("sim:delta"), std::pair(20.0, 0.25));
}

TEST(DeviceChoice, takes_places_of_devices_that_are_not_simulated)
{
    const std::optional<DeviceChoice> udp = parse_device("udp:192.0.2.1:50000");
    ASSERT_TRUE(udp.has_value());
    EXPECT_EQ(udp->kind, DeviceKind::udp);
    EXPECT_EQ(udp->address, "192.0.2.1");
    EXPECT_EQ(udp->port, 50'000);
    const std::optional<DeviceChoice> dhd = parse_device("dhd:63");
    ASSERT_TRUE(dhd.has_value());
    EXPECT_EQ(dhd->kind, DeviceKind::dhd);
    EXPECT_EQ(dhd->index, 63);
    const std::optional<DeviceChoice> replay = parse_device("replay:a:b.rec");
    ASSERT_TRUE(replay.has_value());
    EXPECT_EQ(replay->kind, DeviceKind::replay);
    EXPECT_EQ(replay->recording, "a:b.rec");
}

TEST(DeviceChoice, refuses_what_is_no_device)
{
    for (const char* text : {"", "simulated", "sim:", "sim:Touch", "sim:touch ", "sim:sigma",
                             "udp:80", "udp:", "dhd:64", "dhd:-1", "replay", "replay:"})
    {
        EXPECT_FALSE(parse_device(text).has_value()) << text;
    }
}

TEST(DeviceChoice, takes_faults_of_each_kind)
{
    int kind = 0;
    for (const char* text : {"jitter@0+1", "dropout@7+1000000000", "stuck@1000000000+3", "nan@12+4",
                             "time_jump@12+4", "disconnect@12+4"})
    {
        const std::optional<DeviceFault> fault = parse_device_fault(text);
        ASSERT_TRUE(fault.has_value()) << text;
        EXPECT_EQ(static_cast<int>(fault->kind), kind++);
    }
    const std::optional<DeviceFault> fault = parse_device_fault("dropout@7+1000000000");
    EXPECT_EQ(fault->begin_frame, 7U);
    EXPECT_EQ(fault->frames, 1'000'000'000U);
}

TEST(DeviceChoice, refuses_what_is_no_fault)
{
    for (const char* text :
         {"", "@", "@+", "nan", "nan@", "nan@1", "nan@1+", "nan@+1", "nan@1+0", "nan@-1+1",
          "nan@1+1000000001", "nan@1000000001+1", "nan@1+1+", "nan+1@1", "NaN@1+1", " nan@1+1"})
    {
        EXPECT_FALSE(parse_device_fault(text).has_value()) << text;
    }
}

} // namespace

} // namespace tactus::hrtc::test
