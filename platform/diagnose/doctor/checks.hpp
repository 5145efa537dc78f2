// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/diagnose/doctor/machine_view.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// Checks of the machine. Each returns one finding, without name and effect: both are in the table
/// of examine().
namespace tactus::doctor
{

/// Coarsest resolution of a fine timer. Coarser timers follow ticks, milliseconds apart.
inline constexpr std::int64_t kMostResolution_ns = 1'000;

/// Checks that the clock is read without a system call.
[[nodiscard]] Finding check_clock_source(const MachineView& view);
/// Checks that timers are finer than the kernel's tick.
[[nodiscard]] Finding check_timer(const MachineView& view);
/// Checks that new threads keep denormals and round to nearest.
[[nodiscard]] Finding check_float_control(const MachineView& view);

/// Checks that the kernel has PREEMPT_RT.
[[nodiscard]] Finding check_preemption(const MachineView& view);
/// Checks the share of a processor that real-time threads may use.
[[nodiscard]] Finding check_throttling(const MachineView& view);
/// Checks that the kernel doesn't move locked memory.
[[nodiscard]] Finding check_compaction(const MachineView& view);
/// Checks that the loop's processor is isolated from other threads.
[[nodiscard]] Finding check_isolation(const MachineView& view);
/// Checks that no device interrupts the loop's processor.
[[nodiscard]] Finding check_interrupts(const MachineView& view);

/// Default socket buffers of Cyclone DDS: 1 MiB to receive, 64 KiB to send.
inline constexpr std::int64_t kReceiveBytes = 1024 * 1024;
inline constexpr std::int64_t kSendBytes = 64 * 1024;

/// Parts of a Cyclone DDS configuration that the doctor checks.
struct DdsConfiguration
{
    std::vector<std::string> interfaces; ///< Names of the interfaces; empty: DDS chooses one.
    std::string unreadable_file;         ///< First file that can't be read; empty: none.
};

/// Reads a value of CYCLONEDDS_URI: XML elements and file addresses, separated by commas. The
/// function is no XML parser. Only <NetworkInterface name="..."> and the older
/// <NetworkInterfaceAddress>...</NetworkInterfaceAddress> count; interfaces that are given by
/// address are ignored.
[[nodiscard]] DdsConfiguration read_dds_configuration(std::string_view uri,
                                                      const SystemFiles& files);

/// Checks that the configuration of DDS can be read.
[[nodiscard]] Finding check_dds_configuration(const MachineView& view);
/// Checks that the interface for DDS is up.
[[nodiscard]] Finding check_dds_interface(const MachineView& view);
/// Checks that sockets get the buffers that DDS requests.
[[nodiscard]] Finding check_dds_buffers(const MachineView& view);

/// Longest wake-up time without notable delay, a twentieth of the usual period.
inline constexpr std::int64_t kMostWake_us = 50;

/// Checks that the processor's clock is kept high.
[[nodiscard]] Finding check_governor(const MachineView& view);
/// Checks the longest wake-up time of the processor.
[[nodiscard]] Finding check_idle_states(const MachineView& view);
/// Checks that no other thread can run on the same core.
[[nodiscard]] Finding check_siblings(const MachineView& view);

/// Checks that a thread gets SCHED_FIFO at the priorities of loop and supervisor.
[[nodiscard]] Finding check_priority(const MachineView& view);
/// Checks that all memory of the process can be locked.
[[nodiscard]] Finding check_memory_lock(const MachineView& view);
/// Checks that the kernel doesn't merge pages into huge pages by itself.
[[nodiscard]] Finding check_huge_pages(const MachineView& view);

} // namespace tactus::doctor
