// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/spm_view/live_state.hpp"
#include "rt_core/math/infinity.hpp"

#include <cstdint>
#include <memory>
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

inline RefinementState state()
{
    RefinementState state;
    state.tools.push_back({SafetyState::force, ForceOff::none, "sphere:0.002", 0.002});
    return state;
}

/// A controller whose last sample, of this serial, had the state.
inline dds::WatchedController told(std::uint8_t id, const std::string& name, std::uint64_t serial,
                                   const RefinementState& state)
{
    dds::WatchedController controller = told(id, name);
    controller.serial = serial;
    controller.state = std::make_shared<const dds::SeenState>(dds::SeenState{serial, state});
    return controller;
}

} // namespace tactus::view::test
