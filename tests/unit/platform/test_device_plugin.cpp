// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/plugin/device_plugin.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace tactus::test
{
namespace
{

/// Refusal without the file's name in front.
std::string refusal_of(const std::string& path, const char* words)
{
    const auto device = load_device(path, {1'000, {}, words});
    if (device)
    {
        return "not refused";
    }
    const std::string& text = device.error().text;
    EXPECT_TRUE(text.starts_with(path + ": ")) << text;
    return text.substr(std::min(text.size(), path.size() + 2));
}

TEST(DevicePlugin, a_library_that_makes_no_device_is_refused_with_its_name)
{
    EXPECT_EQ(refusal_of(TACTUS_FAULTY_PLUGIN, "refuses"), "is not plugged in");
    EXPECT_EQ(refusal_of(TACTUS_FAULTY_PLUGIN, ""),
              "its TACTUS_DEVICE_PLUGIN returned no device and no reason");
    EXPECT_EQ(refusal_of(TACTUS_FAULTY_PLUGIN, "throws"),
              "its TACTUS_DEVICE_PLUGIN threw: no such port");
    EXPECT_EQ(refusal_of(TACTUS_FAULTY_PLUGIN, "throws a number"),
              "its TACTUS_DEVICE_PLUGIN threw an exception that is no std::exception");
    EXPECT_EQ(refusal_of(TACTUS_EMPTY_PLUGIN, ""),
              "is no device library: its TACTUS_DEVICE_PLUGIN has no function");
}

TEST(DevicePlugin, a_guard_that_a_library_refuses_is_refused_with_its_name)
{
    const auto refusal = [](const char* words)
    {
        const auto guard = load_guard(TACTUS_FAULTY_PLUGIN, {1'000, {}, words});
        return guard ? std::string("not refused") : guard.error().text;
    };
    const std::string name = std::string(TACTUS_FAULTY_PLUGIN) + ": ";
    EXPECT_EQ(refusal("no guard"), name + "has no second line to its motors");
    EXPECT_EQ(refusal(""), name + "its TACTUS_DEVICE_PLUGIN returned no guard and no reason");
    EXPECT_EQ(refusal("throws"), name + "its TACTUS_DEVICE_PLUGIN threw: no such port");
    EXPECT_FALSE(load_guard("nowhere.so", {1'000, {}, ""}));
}

} // namespace
} // namespace tactus::test
