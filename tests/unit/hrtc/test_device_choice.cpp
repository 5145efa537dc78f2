// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/choices/device_choice.hpp"
#include "platform/choices/device_limits_text.hpp"
#include "platform/devices/simulated/device_classes.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace tactus::hrtc::test
{

namespace
{

TEST(DeviceChoice, takes_a_simulated_device_of_each_class)
{
    const auto force_and_mass_of = [](std::string_view text)
    {
        const auto choice = parse_device(text);
        EXPECT_TRUE(choice.has_value() && choice.value().kind == DeviceKind::simulated) << text;
        return std::pair(choice.value().limits.force_max_n, choice.value().limits.mass_kg);
    };
    EXPECT_EQ(force_and_mass_of("sim"), std::pair(8.0, 0.1));
    EXPECT_EQ(force_and_mass_of("sim:touch"), std::pair(3.3, 0.045));
    EXPECT_EQ(force_and_mass_of("sim:omega"), std::pair(12.0, 0.2));
    EXPECT_EQ(force_and_mass_of("sim:delta"), std::pair(20.0, 0.25));
}

TEST(DeviceChoice, takes_places_of_devices_that_are_not_simulated)
{
    const auto udp = parse_device("udp:192.0.2.1:50000");
    ASSERT_TRUE(udp.has_value());
    EXPECT_EQ(udp.value().kind, DeviceKind::udp);
    EXPECT_EQ(udp.value().address, "192.0.2.1");
    EXPECT_EQ(udp.value().port, 50'000);
    const auto dhd = parse_device("dhd:63");
    ASSERT_TRUE(dhd.has_value());
    EXPECT_EQ(dhd.value().kind, DeviceKind::dhd);
    EXPECT_EQ(dhd.value().index, 63);
    const auto replay = parse_device("replay:a:b.rec");
    ASSERT_TRUE(replay.has_value());
    EXPECT_EQ(replay.value().kind, DeviceKind::replay);
    EXPECT_EQ(replay.value().recording, "a:b.rec");
    const auto plugin = parse_device("plugin:/a/b.so,/dev/x,9600");
    ASSERT_TRUE(plugin.has_value());
    EXPECT_EQ(plugin.value().kind, DeviceKind::plugin);
    EXPECT_EQ(plugin.value().library, "/a/b.so");
    EXPECT_EQ(plugin.value().words, "/dev/x,9600");
    EXPECT_EQ(parse_device("plugin:/b.so").value().words, "");
}

TEST(DeviceChoice, refuses_what_is_no_device)
{
    for (const char* text : {"", "simulated", "sim:", "sim:Touch", "sim:touch ", "sim:sigma",
                             "udp:80", "udp:", "dhd:64", "dhd:-1", "replay", "replay:", "plugin",
                             "plugin:", "plugin:,/a", "plugin:b.so", "plugin:./b.so"})
    {
        EXPECT_FALSE(parse_device(text).has_value()) << text;
    }
}

TEST(DeviceLimitsText, sets_what_it_names_and_nothing_else)
{
    DeviceLimits limits = kDeskClass;
    EXPECT_EQ(set_device_limits("mass_kg=0.2,rotation.inertia_kg_m2=3e-4,delay_s=0", limits), "");
    DeviceLimits wanted = kDeskClass;
    wanted.mass_kg = 0.2;
    wanted.rotation.inertia_kg_m2 = 3e-4;
    EXPECT_EQ(limits, wanted);
}

TEST(DeviceLimitsText, has_a_key_for_each_number)
{
    DeviceLimits limits = kDeskClass;
    EXPECT_EQ(set_device_limits("mass_kg=1,damping_n_s_per_m=2,friction_n=3,quantum_m=4,"
                                "delay_s=0.05,force_max_n=6,slew_max_n_per_s=7,"
                                "stiffness_max_n_per_m=8,added_damping_max_n_s_per_m=9,"
                                "rotation.torque_max_nm=10,rotation.inertia_kg_m2=11,"
                                "rotation.damping_nm_s_per_rad=12,rotation.friction_nm=13,"
                                "rotation.quantum_rad=14,rotation.slew_max_nm_per_s=15,"
                                "rotation.stiffness_max_nm_per_rad=16,"
                                "rotation.added_damping_max_nm_s_per_rad=17",
                                limits),
              "");
    const RotationLimits turn{true, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0, 16.0, 17.0};
    EXPECT_EQ(limits, (DeviceLimits{1.0, 2.0, 3.0, 4.0, 0.05, 6.0, 7.0, 8.0, 9.0, turn}));
}

TEST(DeviceLimitsText, changes_nothing_when_it_refuses)
{
    for (const auto& [text, fault] :
         {std::pair("", "is not KEY=VALUE; the keys are mass_kg, "),
          std::pair("mass_kg", "'mass_kg' is not KEY=VALUE"),
          std::pair("friction_n=1,", "'' is not KEY=VALUE"),
          std::pair("friction_n=1,mass=2", "'mass=2' is not KEY=VALUE"),
          std::pair("inertia_kg_m2=1", "rotation.inertia_kg_m2"),
          std::pair("mass_kg=", "mass_kg: '' is not a number"),
          std::pair("mass_kg=1kg", "mass_kg: '1kg' is not a number"),
          std::pair("mass_kg=nan", "mass_kg: 'nan' is not a number"),
          std::pair("mass_kg=1,mass_kg=1", "mass_kg is given twice"),
          std::pair("friction_n=1,mass_kg=0", "mass_kg must be finite and > 0"),
          std::pair("force_max_n=2000", "force_max_n must be at most 1000"),
          std::pair("delay_s=1", "delay_s must be at most 0.1"),
          std::pair("rotation.inertia_kg_m2=0", "inertia_kg_m2 must be finite and > 0")})
    {
        DeviceLimits limits = kDeskClass;
        EXPECT_NE(set_device_limits(text, limits).find(fault), std::string::npos)
            << text << ": " << set_device_limits(text, limits);
        EXPECT_EQ(limits, kDeskClass) << text;
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
