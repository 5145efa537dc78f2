// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/plugin/device_plugin.hpp"

#include "platform/devices/remote/remote_values.hpp"

#include <dlfcn.h>
#include <exception>

namespace tactus
{

namespace
{

/// Calls a function of the library. An exception or a null result becomes a refusal.
template <class Made>
Result<std::unique_ptr<Made>, Refusal>
make_by(Result<std::unique_ptr<Made>, Refusal> (*make)(const DeviceRequest&),
        const DeviceRequest& request, const char* what)
{
    const std::string its = "its TACTUS_DEVICE_PLUGIN ";
    try
    {
        auto made = make(request);
        if (made && made.value() == nullptr)
        {
            return Refusal{its + "returned no " + what + " and no reason"};
        }
        return made;
    }
    catch (const std::exception& fault)
    {
        return Refusal{its + "threw: " + fault.what()};
    }
    catch (...)
    {
        return Refusal{its + "threw an exception that is no std::exception"};
    }
}

/// Refusal prefixed by the file's name.
Refusal behind(const std::string& path, const std::string& text)
{
    return {path + ": " + text};
}

Result<const DevicePlugin*, Refusal> load_plugin(const std::string& path)
{
    if (!path.starts_with('/'))
    {
        return behind(path, "give the full path of the library");
    }
    void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr)
    {
        const char* reason = dlerror();
        const std::string text = reason == nullptr ? "no reason given" : reason;
        return behind(path, "can't be loaded: " + text.substr(0, text.find('\n')));
    }
    const auto* plugin = static_cast<const DevicePlugin*>(dlsym(library, "tactus_device_plugin"));
    if (plugin == nullptr)
    {
        return behind(path, "is no device library: it has no TACTUS_DEVICE_PLUGIN");
    }
    if (plugin->layout != kPluginLayout)
    {
        return behind(
            path, "is for another version of Tactus; compile it with the headers of this version");
    }
    if (plugin->make == nullptr)
    {
        return behind(path, "is no device library: its TACTUS_DEVICE_PLUGIN has no function");
    }
    return plugin;
}

} // namespace

Result<std::unique_ptr<HapticDevice>, Refusal> load_device(const std::string& path,
                                                           const DeviceRequest& request)
{
    const auto plugin = load_plugin(path);
    if (!plugin)
    {
        return plugin.error();
    }
    auto device = make_by(plugin.value()->make, request, "device");
    if (!device)
    {
        return behind(path, device.error().text);
    }
    if (const char* fault = find_fault(device.value()->info()))
    {
        return behind(path, fault);
    }
    return device;
}

Result<std::unique_ptr<DeviceGuard>, Refusal> load_guard(const std::string& path,
                                                         const DeviceRequest& request)
{
    const auto plugin = load_plugin(path);
    if (!plugin)
    {
        return plugin.error();
    }
    if (plugin.value()->guard == nullptr)
    {
        return std::unique_ptr<DeviceGuard>();
    }
    auto guard = make_by(plugin.value()->guard, request, "guard");
    if (!guard)
    {
        return behind(path, guard.error().text);
    }
    return guard;
}

bool has_guard(const std::string& path)
{
    const auto plugin = load_plugin(path);
    return plugin && plugin.value()->guard != nullptr;
}

} // namespace tactus
