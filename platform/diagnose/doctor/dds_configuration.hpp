// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/diagnose/doctor/system_files.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tactus::doctor
{

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

} // namespace tactus::doctor
