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
}

TEST(DeviceChoice, refuses_what_is_no_device)
{
    for (const char* text : {"", "simulated", "sim:", "sim:Touch", "sim:touch ", "sim:sigma",
                             "udp:80", "udp:", "dhd:64", "dhd:-1"})
    {
        EXPECT_FALSE(parse_device(text).has_value()) << text;
    }
}

} // namespace

} // namespace tactus::hrtc::test
