// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/scenes.hpp"

#include <cstdint>

namespace tactus::bench
{

/// From now on this process and those that it starts have a network of their own, of a loopback
/// interface alone. The caller must have no other threads. A failure when the system doesn't allow
/// it.
void enter_own_network();

/// What has gone over it so far: each datagram once, with its headers.
[[nodiscard]] std::uint64_t loopback_bytes();

} // namespace tactus::bench
