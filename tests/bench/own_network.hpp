// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/scenes.hpp"

#include <cstdint>

namespace tactus::bench
{

/// Moves this process and its future children to a network namespace with a loopback interface
/// only. The caller must have no other threads. A failure if the system does not permit it.
void enter_own_network();

/// Bytes sent over it so far: each datagram once, with its headers.
[[nodiscard]] std::uint64_t loopback_bytes();

} // namespace tactus::bench
