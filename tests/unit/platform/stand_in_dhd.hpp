// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>

namespace tactus::test
{

/// State of one device in a stand-in for Force Dimension's SDK: 0.1 kg on a spring of 200 N/m. It
/// moves only in step(), so that a test controls its time.
struct StandInDhdDevice
{
    void step()
    {
        const std::lock_guard lock(mutex);
        const double damping = brakes ? 60.0 : 6.0;
        for (std::size_t i = 0; i < 3; ++i)
        {
            const double force = brakes || !forces_enabled ? 0.0 : force_n.at(i);
            velocity.at(i) +=
                1e-3 * (force - 200.0 * position_m.at(i) - damping * velocity.at(i)) / 0.1;
            position_m.at(i) += 1e-3 * velocity.at(i);
        }
    }

    std::mutex mutex;
    std::array<double, 3> position_m{};
    std::array<double, 3> velocity{};
    std::array<double, 3> force_n{};
    bool brakes{true};
    bool forces_enabled{false};
    std::array<double, 9> frame{1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}; ///< Matrix by rows.
    std::array<double, 3> turning{};
    std::array<double, 3> torque_nm{};
    double gap_m{0.0};
    double grip_n{0.0};
    std::array<int, 2> buttons{};
    std::atomic<bool> has_wrist{true};
    std::atomic<bool> has_active_wrist{true};
    std::atomic<bool> has_gripper{false};
    std::atomic<bool> is_open{false};
    std::atomic<bool> is_plugged_in{true};
    std::atomic<bool> has_velocity{true};
    std::atomic<bool> has_brakes{true};
    std::atomic<std::uint64_t> reads{0};
    std::atomic<int> watchdog_steps{0}; ///< Steps of 125 us.
};

struct StandInDhd
{
    std::atomic<int> count{8};
    std::array<StandInDhdDevice, 8> devices;
};

/// Variable TACTUS_DHD_LOG: its file makes a device that outlives the program. It accepts one
/// program at a time, its hand moves along z by 2 cm in 4 s, and each force is written to the file,
/// in lines like those of tests/hostile/recording_device.cpp.
inline constexpr const char* kDhdLogVariable = "TACTUS_DHD_LOG";

/// Name of the stand-in's function that returns it.
inline constexpr const char* kStandInDhdName = "tactus_stand_in_dhd";
using StandInDhdFunction = StandInDhd*();

} // namespace tactus::test
