// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/spm_view/live_state.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

// Feed for graphics programs (docs/feed.md): one list of fields, as JSON and as datagrams. Any
// thread: results depend on the arguments alone; they allocate.
namespace tactus::view
{

/// Version of the fields, in both forms. Fields are only added with another version.
inline constexpr std::uint16_t kFeedVersion = 1;
/// Maximum number of objects in one datagram.
inline constexpr std::size_t kFeedObjects = 64;

/// Newest state of a controller as one line of JSON, with all its known objects.
[[nodiscard]] std::string feed_json(const LiveController& controller);

/// The same fields as datagrams of at most 14,464 bytes: packed little-endian records in the order
/// of docs/examples/tactus_feed.h. Each has all tools; the objects are divided among them.
[[nodiscard]] std::vector<std::string> feed_datagrams(const LiveController& controller);

} // namespace tactus::view
