// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/diagnose/doctor/system_files.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tactus::doctor
{

/// What the doctor wants to know of a configuration of Cyclone DDS.
struct DdsConfiguration
{
    std::vector<std::string> interfaces; ///< As named; empty: DDS takes one by itself.
    std::string unreadable_file;         ///< The first that can't be read; empty: none.
};

/// Reads a value of CYCLONEDDS_URI: elements of XML and addresses of files, separated by commas.
/// No parser of XML: it looks for <NetworkInterface name="..."> and for the elder
/// <NetworkInterfaceAddress>...</NetworkInterfaceAddress>, and leaves all else to DDS. Interfaces
/// that are given by address are none to it.
[[nodiscard]] DdsConfiguration read_dds_configuration(std::string_view uri,
                                                      const SystemFiles& files);

} // namespace tactus::doctor
