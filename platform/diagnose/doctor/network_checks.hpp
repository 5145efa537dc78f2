// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/diagnose/doctor/machine_view.hpp"

#include <cstdint>

/// Checks of the network that carries the models.
namespace tactus::doctor
{

/// Default socket buffers of Cyclone DDS: 1 MiB to receive, 64 KiB to send.
inline constexpr std::int64_t kReceiveBytes = 1024 * 1024;
inline constexpr std::int64_t kSendBytes = 64 * 1024;

/// Checks that the configuration of DDS can be read.
[[nodiscard]] Finding check_dds_configuration(const MachineView& view);
/// Checks that the interface for DDS is up.
[[nodiscard]] Finding check_dds_interface(const MachineView& view);
/// Checks that sockets get the buffers that DDS requests.
[[nodiscard]] Finding check_dds_buffers(const MachineView& view);

} // namespace tactus::doctor
