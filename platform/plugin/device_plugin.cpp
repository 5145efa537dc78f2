// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/plugin/device_plugin.hpp"

#include "platform/remote/info_fault.hpp"

#include <dlfcn.h>
#include <exception>
#include <utility>

namespace tactus
{

namespace
{

/// A library is foreign code: what it throws is its refusal, and nothing at all is one, too.
Result<std::unique_ptr<HapticDevice>, Refusal> make_device(MakeDevice make, const DeviceWish& wish)
{
    try
    {
        auto device = make(wish);
        if (device && device.value() == nullptr)
        {
            return Refusal{"its TACTUS_DEVICE_PLUGIN makes no device and says no reason"};
        }
        return device;
    }
    catch (const std::exception& fault)
    {
        return Refusal{std::string("its TACTUS_DEVICE_PLUGIN threw: ") + fault.what()};
    }
    catch (...)
    {
        return Refusal{"its TACTUS_DEVICE_PLUGIN threw what is no std::exception"};
    }
}

} // namespace

Result<std::unique_ptr<HapticDevice>, Refusal> load_device(const std::string& path,
                                                           const DeviceWish& wish)
{
    const bool has_folder = path.find('/') != std::string::npos;
    void* library = dlopen((has_folder ? path : "./" + path).c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr)
    {
        const char* reason = dlerror();
        const std::string text = reason == nullptr ? "no reason given" : reason;
        return Refusal{path + ": can't be loaded: " + text.substr(0, text.find('\n'))};
    }
    const auto* plugin = static_cast<const DevicePlugin*>(dlsym(library, "tactus_device_plugin"));
    if (plugin == nullptr)
    {
        return Refusal{path + ": is no device: it has no TACTUS_DEVICE_PLUGIN"};
    }
    if (plugin->layout != kPluginLayout)
    {
        return Refusal{path + ": is of another version; compile it with the headers of this one"};
    }
    if (plugin->make == nullptr)
    {
        return Refusal{path + ": is no device: its TACTUS_DEVICE_PLUGIN has no function"};
    }
    auto device = make_device(plugin->make, wish);
    if (!device)
    {
        return Refusal{path + ": " + device.error().text};
    }
    if (const char* fault = find_fault(device.value()->info()))
    {
        return Refusal{path + ": " + fault};
    }
    return device;
}

} // namespace tactus
