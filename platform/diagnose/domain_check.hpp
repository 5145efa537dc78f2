// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/diagnose/doctor/finding.hpp"

#include <chrono>
#include <cstdint>

namespace tactus::hrtc
{

/// Joins a DDS domain, 0 to 232, as a controller, listens for so long, and says who is heard there
/// and which models are published: good when there are some, critical when the domain can't be
/// joined. From an ordinary thread; waits.
[[nodiscard]] doctor::Finding check_domain(std::uint32_t domain, std::chrono::milliseconds wait);

} // namespace tactus::hrtc
