// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/spm_view/live_state.hpp"
#include "rt_core/math/infinity.hpp"

#include <cstdint>
#include <string>

/// Controllers as DDS reports them.
namespace tactus::view::test
{

inline dds::WatchedController told(std::uint8_t id, const std::string& name)
{
    dds::WatchedController controller;
    controller.id.fill(id);
    controller.name = name;
    controller.telemetry.tool_count = 1;
    controller.telemetry.tools[0].force_n = {0.0, 3.0, 4.0};
    controller.telemetry.pair_count = 1; // The pair's distance is unknown: infinite.
    controller.telemetry.pairs[0].upper_m = kInfinity;
    return controller;
}

inline dds::SeenFront front(std::uint8_t id, std::uint64_t serial)
{
    dds::SeenFront seen;
    seen.id.fill(id);
    seen.serial = serial;
    seen.front.tools.push_back({SafetyState::force, ForceOff::none, "sphere:0.002", 0.002});
    return seen;
}

} // namespace tactus::view::test
