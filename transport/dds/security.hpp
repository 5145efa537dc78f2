// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/dds/key_folder.hpp"

#include <string>

struct dds_qos; // Cyclone's.

namespace tactus::dds
{

/// Adds the three plugins of DDS Security, with these keys, to the QoS of a participant.
void protect(dds_qos* participant, const KeyFolder& keys);

/// True if a value of CYCLONEDDS_URI opens programs to a network without keys: it names another
/// interface than loopback, or none, and has no element <Security>. Reads the named files; Cyclone
/// refuses unreadable ones. Searches the text and does not parse XML.
[[nodiscard]] bool is_open_to_network(const std::string& cyclonedds_uri);

} // namespace tactus::dds
