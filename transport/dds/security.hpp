// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/dds/key_folder.hpp"

#include <string>

struct dds_qos; // Cyclone's.

namespace tactus::dds
{

/// Puts the three plugins of DDS Security, with these keys, into a participant's quality of
/// service.
void protect(dds_qos* participant, const KeyFolder& keys);

/// Whether a value of CYCLONEDDS_URI leaves programs open to a network: it names other interfaces
/// than loopback, or none, and has no element <Security>. Reads the files that it names; one that
/// can't be read is Cyclone's to refuse. No parser of XML.
[[nodiscard]] bool is_open_to_network(const std::string& cyclonedds_uri);

} // namespace tactus::dds
