// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/placement.hpp"

#include <algorithm>
#include <iterator>

#include "tactus.h"

namespace tactus::dds
{

tactus_v2_Placement to_wire(const Pose& pose) noexcept
{
    tactus_v2_Placement wire = {};
    std::ranges::copy(pose.rotation, std::begin(wire.rotation));
    std::ranges::copy(pose.translation_m, std::begin(wire.translation_m));
    wire.scale = pose.scale;
    return wire;
}

Pose from_wire(const tactus_v2_Placement& wire) noexcept
{
    Pose pose;
    std::ranges::copy(wire.rotation, pose.rotation.begin());
    std::ranges::copy(wire.translation_m, pose.translation_m.begin());
    pose.scale = wire.scale;
    return pose;
}

} // namespace tactus::dds
