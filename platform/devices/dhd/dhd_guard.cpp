// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/dhd/dhd_guard.hpp"

#include <chrono>
#include <thread>
#include <utility>

namespace tactus
{

namespace
{

constexpr int kTries = 2'000;
constexpr std::chrono::milliseconds kBetweenTries{1};

} // namespace

Result<std::unique_ptr<DeviceGuard>, Refusal> DhdGuard::create(const std::string& library,
                                                               int index)
{
    auto loaded = DhdLibrary::load(library);
    if (!loaded)
    {
        return loaded.error();
    }
    return std::unique_ptr<DeviceGuard>(new DhdGuard(std::move(loaded).value(), index));
}

DhdGuard::DhdGuard(DhdLibrary library, int index)
    : library_(std::move(library)), index_(static_cast<char>(index))
{
}

bool DhdGuard::brake() noexcept
{
    int id = -1;
    for (int i = 0; i < kTries && id < 0; ++i)
    {
        id = index_ < library_->dhdGetDeviceCount() ? library_->dhdOpenID(index_) : -1;
        if (id < 0)
        {
            std::this_thread::sleep_for(kBetweenTries);
        }
    }
    if (id < 0)
    {
        return false;
    }
    const char opened = static_cast<char>(id);
    const bool is_free =
        library_->dhdSetForceAndTorqueAndGripperForce(0, 0, 0, 0, 0, 0, 0, opened) >= 0;
    const bool is_braked = library_->dhdSetBrakes(1, opened) >= 0; // Not every device has brakes.
    const bool is_off = library_->dhdEnableForce(0, opened) >= 0;
    library_->dhdClose(opened);
    return is_free || is_braked || is_off;
}

} // namespace tactus
