// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
/// Library that exports the functions of Force Dimension's SDK that platform/devices/dhd uses;
/// without dhdSetForceAndTorqueAndGripperForce if STAND_IN_DHD_IS_OLD is defined.
#include "tests/unit/platform/stand_in_dhd.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace
{

using tactus::test::StandInDhd;
using tactus::test::StandInDhdDevice;

std::int64_t now_ns()
{
    std::timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

StandInDhd stand_in;
const std::int64_t start_ns = now_ns();

StandInDhdDevice& device_of(char id)
{
    return stand_in.devices.at(static_cast<std::size_t>(id));
}

/// Returns 0 or -1 like the SDK.
template <typename Work>
int on(char id, const Work& work)
{
    StandInDhdDevice& device = device_of(id);
    if (!device.is_open || !device.is_plugged_in)
    {
        return -1;
    }
    const std::lock_guard lock(device.mutex);
    work(device);
    return 0;
}

/// Device that outlives the program; no effect without a log.
struct Hardware
{
    Hardware() : log_(std::getenv(tactus::test::kDhdLogVariable)) {}

    [[nodiscard]] bool is_there() const { return log_ != nullptr; }
    /// Opens the device with a lock, which the system releases when its process ends.
    bool try_open()
    {
        lock_ = is_there() ? ::open(log_, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644) : -1;
        const bool is_mine = !is_there() || ::flock(lock_, LOCK_EX | LOCK_NB) == 0;
        if (!is_mine)
        {
            ::close(lock_);
        }
        is_first_ = true;
        return is_mine;
    }
    void close() const
    {
        if (is_there())
        {
            ::close(lock_);
        }
    }
    /// Logs a force; a program's first call logs the change of program.
    void make_force(double x, double y, double z)
    {
        if (is_there())
        {
            std::array<char, 160> line{};
            const int length = std::snprintf(line.data(), line.size(), "%lld %.6f %.6f %.6f %s\n",
                                             static_cast<long long>(now_ns()), x, y, z,
                                             is_first_ ? "opened" : "force");
            is_first_ = false;
            [[maybe_unused]] const ssize_t written =
                ::write(lock_, line.data(), static_cast<std::size_t>(length));
        }
    }

private:
    const char* log_;
    int lock_{-1};
    bool is_first_{true};
};

Hardware hardware;

} // namespace

extern "C"
{

    StandInDhd* tactus_stand_in_dhd()
    {
        return &stand_in;
    }

    int dhdGetDeviceCount()
    {
        return stand_in.count;
    }

    int dhdOpenID(char index)
    {
        StandInDhdDevice& device = device_of(index);
        if (!device.is_plugged_in || device.is_open.exchange(true))
        {
            return -1;
        }
        if (!hardware.try_open())
        {
            device.is_open = false;
            return -1;
        }
        const std::lock_guard lock(device.mutex);
        device.brakes = true;
        device.forces_enabled = false;
        return index;
    }

    int dhdClose(char id)
    {
        hardware.close();
        return device_of(id).is_open.exchange(false) ? 0 : -1;
    }

    const char* dhdGetSystemName(char)
    {
        return "stand-in\n";
    }

    int dhdGetPosition(double* x, double* y, double* z, char id)
    {
        ++device_of(id).reads;
        if (hardware.is_there())
        {
            *x = 0.0;
            *y = 0.0;
            *z = 0.02 * std::cos(1.5707963 * 1e-9 * static_cast<double>(now_ns() - start_ns));
            return 0;
        }
        return on(id,
                  [&](const StandInDhdDevice& device)
                  {
                      *x = device.position_m[0];
                      *y = device.position_m[1];
                      *z = device.position_m[2];
                  });
    }

    int dhdGetLinearVelocity(double* x, double* y, double* z, char id)
    {
        if (!device_of(id).has_velocity)
        {
            return -1;
        }
        return on(id,
                  [&](const StandInDhdDevice& device)
                  {
                      *x = device.velocity[0];
                      *y = device.velocity[1];
                      *z = device.velocity[2];
                  });
    }

    int dhdGetButton(int index, char id)
    {
        int pressed = -1;
        static_cast<void>(on(id,
                             [&](const StandInDhdDevice& device)
                             {
                                 const auto at = static_cast<std::size_t>(index);
                                 pressed = at < device.buttons.size() ? device.buttons.at(at) : -1;
                             }));
        return pressed;
    }

    unsigned dhdGetButtonMask(char id)
    {
        unsigned mask = 0;
        static_cast<void>(on(id,
                             [&](const StandInDhdDevice& device)
                             {
                                 for (std::size_t i = 0; i < device.buttons.size(); ++i)
                                 {
                                     mask |= device.buttons.at(i) != 0 ? 1U << i : 0U;
                                 }
                             }));
        return mask;
    }

    bool dhdHasWrist(char id)
    {
        return device_of(id).has_wrist;
    }

    bool dhdHasActiveWrist(char id)
    {
        return device_of(id).has_active_wrist;
    }

    bool dhdHasGripper(char id)
    {
        return device_of(id).has_gripper;
    }

    bool dhdHasActiveGripper(char id)
    {
        return device_of(id).has_gripper;
    }

    int dhdGetOrientationFrame(double matrix[3][3], char id)
    {
        return on(id,
                  [&](const StandInDhdDevice& device)
                  {
                      for (std::size_t i = 0; i < 9; ++i)
                      {
                          matrix[i / 3][i % 3] = device.frame.at(i);
                      }
                  });
    }

    int dhdGetAngularVelocityRad(double* x, double* y, double* z, char id)
    {
        return on(id,
                  [&](const StandInDhdDevice& device)
                  {
                      *x = device.turning[0];
                      *y = device.turning[1];
                      *z = device.turning[2];
                  });
    }

    int dhdGetGripperGap(double* gap, char id)
    {
        return on(id, [&](const StandInDhdDevice& device) { *gap = device.gap_m; });
    }

#ifndef STAND_IN_DHD_IS_OLD
    int dhdSetForceAndTorqueAndGripperForce(double fx, double fy, double fz, double tx, double ty,
                                            double tz, double grip, char id)
    {
        return on(id,
                  [&](StandInDhdDevice& device)
                  {
                      hardware.make_force(fx, fy, fz);
                      device.force_n = {fx, fy, fz};
                      device.torque_nm = {tx, ty, tz};
                      device.grip_n = grip;
                  });
    }
#endif

    int dhdSetBrakes(int is_on, char id)
    {
        if (!device_of(id).has_brakes)
        {
            return -1;
        }
        return on(id, [&](StandInDhdDevice& device) { device.brakes = is_on != 0; });
    }

    int dhdEnableForce(unsigned char is_on, char id)
    {
        return on(id, [&](StandInDhdDevice& device) { device.forces_enabled = is_on != 0; });
    }

    int dhdSetWatchdog(unsigned char steps, char id)
    {
        return on(id, [&](StandInDhdDevice& device) { device.watchdog_steps = steps; });
    }

    const char* dhdErrorGetLastStr()
    {
        return "device in use";
    }

} // extern "C"
