// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/diagnose/doctor/machine_view.hpp"

#include <cstdint>

/// What models come over.
namespace tactus::doctor
{

/// What Cyclone DDS asks for when its configuration does not say: 1 MiB to receive, 64 KiB to send.
inline constexpr std::int64_t kReceiveBytes = 1024 * 1024;
inline constexpr std::int64_t kSendBytes = 64 * 1024;

/// What configures DDS, and whether it can be read.
[[nodiscard]] Finding check_dds_configuration(const MachineView& view);
/// Whether the interface that DDS will take is up.
[[nodiscard]] Finding check_dds_interface(const MachineView& view);
/// Whether sockets get the buffers that DDS asks for.
[[nodiscard]] Finding check_dds_buffers(const MachineView& view);

} // namespace tactus::doctor
