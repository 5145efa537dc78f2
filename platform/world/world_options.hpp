// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

// Any thread: values.
namespace tactus
{

/// Options of a World: those of `hrtc` under the same names, with its ranges and defaults. SI
/// units. World::start() and the first step refuse a value out of range in one line.
struct WorldOptions
{
    std::int64_t rate_hz{1'000};     ///< Rate of the loop, 100 to 10,000.
    double memory_mib{2.0};          ///< Memory of pools, tables and queues, 0.25 to 4,096.
    double stiffness_n_per_m{500.0}; ///< Stiffness of the virtual wall, 1 to 3,000.
    /// Stiffness of the rotational spring, 1e-3 to 100 N m/rad. [default: from stiffness and size]
    std::optional<double> angular_stiffness_nm_per_rad{};
    std::optional<double> shading_m{}; ///< Width of force shading, 1e-4 to 0.1. [default: none]
    double force_tolerance_n{0.001};   ///< Largest change of a force by coarser levels.
    double object_speed_m_per_s{0.5};  ///< Speed limit of objects near a tool, 0.001 to 100.
    std::optional<double>
        proxy_speed_m_per_s{}; ///< Speed limit of the proxy. [default: 1 diagonal]
    std::optional<double> speed_limit_m_per_s{};  ///< Speed of a hand above which its force fades.
    std::optional<std::uint32_t> clutch_button{}; ///< Clutch button of each device, 0 to 31.
    /// Largest number of objects at once. [default: the number at the start]
    std::uint32_t objects_max{0};
    /// True: a model that fits the memory is loaded and refined as a whole.
    bool loads_whole{true};

    double wait_s{10.0};      ///< Longest wait for a device or a published model, 0.1 to 3,600.
    std::uint32_t domain{0};  ///< DDS domain of published models, 0 to 232.
    bool is_watched{false};   ///< True: viewers (spm_view) on the domain can see the World.
    bool follows_poses{true}; ///< True: servers move the objects of their models.
    std::string name{};       ///< Name on the domain. [default: hrtc-PID]

    std::string record{}; ///< File of a recording for `hrtc --replay`; empty: none.
    std::string trace{};  ///< File of a trace of start()'s loop; empty: none.
    /// Duration of start()'s loop, 0.1 to 86,400 s. [default: until stop()]
    std::optional<double> duration_s{};

    int priority{80};                                  ///< SCHED_FIFO priority of the loop.
    std::optional<int> cpu{};                          ///< Processor of the loop. [default: any]
    std::optional<std::uint32_t> supervisor_periods{}; ///< Silent periods until it brakes.
    /// True: the loop runs without SCHED_FIFO or locked memory if the system refuses them.
    bool allow_no_rt{false};
    /// True: no process that brakes dhd and plugin devices if this one is killed.
    bool has_no_guardian{false};
};

} // namespace tactus
