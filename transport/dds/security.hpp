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
/// interface than loopback, or none, and has no element <Security>. Also true if a named file is no
/// regular one of 1 byte to 1 MiB; false if one is missing, since Cyclone refuses that. Searches
/// the text and does not parse XML: elements count for every domain.
[[nodiscard]] bool is_open_to_network(const std::string& cyclonedds_uri);

} // namespace tactus::dds
