// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/pose.hpp"

struct tactus_v2_Placement; // idlc's type.

namespace tactus::dds
{

/// A pose to the wire, and from it as it came: see checked_pose().
[[nodiscard]] tactus_v2_Placement to_wire(const Pose& pose) noexcept;
[[nodiscard]] Pose from_wire(const tactus_v2_Placement& wire) noexcept;

} // namespace tactus::dds
