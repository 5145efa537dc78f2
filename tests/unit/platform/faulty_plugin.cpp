// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Library for --device plugin that fails as its words say.

#include "platform/devices/plugin/device_plugin.hpp"

#include <stdexcept>
#include <string_view>

namespace
{

#ifndef PLUGIN_IS_EMPTY
tactus::Result<std::unique_ptr<tactus::HapticDevice>, tactus::Refusal>
make_faulty(const tactus::DeviceRequest& request)
{
    const std::string_view words = request.words;
    if (words == "throws")
    {
        throw std::runtime_error("no such port");
    }
    if (words == "throws a number")
    {
        throw 7;
    }
    if (words == "refuses")
    {
        return tactus::Refusal{"is not plugged in"};
    }
    return std::unique_ptr<tactus::HapticDevice>();
}

tactus::Result<std::unique_ptr<tactus::DeviceGuard>, tactus::Refusal>
make_no_guard(const tactus::DeviceRequest& request)
{
    const std::string_view words = request.words;
    if (words == "throws")
    {
        throw std::runtime_error("no such port");
    }
    if (words == "no guard")
    {
        return tactus::Refusal{"has no second line to its motors"};
    }
    return std::unique_ptr<tactus::DeviceGuard>();
}
#else
constexpr tactus::MakeDevice make_faulty = nullptr;
constexpr tactus::MakeGuard make_no_guard = nullptr;
#endif

} // namespace

TACTUS_DEVICE_PLUGIN(make_faulty, make_no_guard);
