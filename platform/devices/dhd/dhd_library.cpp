// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/dhd/dhd_library.hpp"

#include <dlfcn.h>
#include <utility>

namespace tactus
{

namespace
{

/// Looks up a function; false if the library lacks it.
template <typename Function>
bool find(void* handle, const char* name, Function*& function) noexcept
{
    function = reinterpret_cast<Function*>(dlsym(handle, name));
    return function != nullptr;
}

/// First line of the loader's message.
std::string loaders_reason()
{
    const char* reason = dlerror();
    const std::string text = reason == nullptr ? "no reason given" : reason;
    return text.substr(0, text.find('\n'));
}

Refusal refuse_library(std::string line)
{
    return {std::move(line)};
}

} // namespace

Result<DhdLibrary, Refusal> DhdLibrary::load(const std::string& path)
{
    const char* name = path.empty() ? "libdhd.so.3" : path.c_str();
    void* handle = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr && path.empty())
    {
        name = "libdhd.so";
        handle = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    }
    if (handle == nullptr)
    {
        const char* hint = path.empty() ? "; install Force Dimension's SDK or give the path of its "
                                          "libdhd.so"
                                        : "";
        return refuse_library("dhd device: the SDK can't be loaded (" + loaders_reason() + ")" +
                              hint);
    }
    DhdLibrary library(handle);
    if (const char* missing = library.find_functions(); missing != nullptr)
    {
        return refuse_library("dhd device: " + std::string(name) + " has no function " + missing +
                              "; Force Dimension's SDK 3 is required");
    }
    return library;
}

const char* DhdLibrary::find_functions() noexcept
{
    const char* missing = nullptr;
    const auto want = [&](const char* name, auto*& function)
    {
        if (!find(handle_, name, function))
        {
            missing = missing == nullptr ? name : missing;
        }
    };
    want("dhdGetDeviceCount", functions_.dhdGetDeviceCount);
    want("dhdOpenID", functions_.dhdOpenID);
    want("dhdClose", functions_.dhdClose);
    want("dhdGetSystemName", functions_.dhdGetSystemName);
    want("dhdGetPosition", functions_.dhdGetPosition);
    want("dhdGetLinearVelocity", functions_.dhdGetLinearVelocity);
    want("dhdGetButton", functions_.dhdGetButton);
    want("dhdGetOrientationFrame", functions_.dhdGetOrientationFrame);
    want("dhdGetAngularVelocityRad", functions_.dhdGetAngularVelocityRad);
    want("dhdGetGripperGap", functions_.dhdGetGripperGap);
    want("dhdHasWrist", functions_.dhdHasWrist);
    want("dhdHasActiveWrist", functions_.dhdHasActiveWrist);
    want("dhdHasGripper", functions_.dhdHasGripper);
    want("dhdHasActiveGripper", functions_.dhdHasActiveGripper);
    want("dhdGetButtonMask", functions_.dhdGetButtonMask);
    want("dhdSetForceAndTorqueAndGripperForce", functions_.dhdSetForceAndTorqueAndGripperForce);
    want("dhdSetBrakes", functions_.dhdSetBrakes);
    want("dhdEnableForce", functions_.dhdEnableForce);
    want("dhdErrorGetLastStr", functions_.dhdErrorGetLastStr);
    find(handle_, "dhdSetWatchdog", functions_.dhdSetWatchdog); // This function is optional.
    return missing;
}

DhdLibrary::DhdLibrary(DhdLibrary&& other) noexcept
    : handle_(std::exchange(other.handle_, nullptr)), functions_(other.functions_)
{
}

DhdLibrary::~DhdLibrary()
{
    if (handle_ != nullptr)
    {
        dlclose(handle_);
    }
}

} // namespace tactus
