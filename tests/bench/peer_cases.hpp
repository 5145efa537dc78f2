// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/cases.hpp"

#include <cstddef>
#include <optional>
#include <string>

namespace tactus::bench
{

/// Goals of our own answers, not of the peers': exact to rounding, no touch missed or invented, no
/// heap call.
inline constexpr double kOurError_diag = 1e-9;
[[nodiscard]] inline std::optional<double> our_goal(const std::string& by, double goal)
{
    return by.starts_with("Tactus") ? std::optional(goal) : std::nullopt;
}

/// One sphere in the touching motion, for every contestant.
struct PeerTouchCase
{
    const char* part;
    SceneSource scene;
    const char* setting;
    /// Pools of the streaming contestant; empty: there is none.
    std::optional<std::size_t> pool_bytes;
};
/// Workloads W1 and W3: near frames with a band of two radii, flight without one, errors about
/// touch, and cost of construction and memory.
void run_peer_touch_case(const CaseContext& context, const PeerTouchCase& test_case);

struct PeerMeshCase
{
    SceneSource scene;
};
/// Workload W2: a mesh tool rotates and slides through the surface.
void run_peer_mesh_case(const CaseContext& context, const PeerMeshCase& test_case);

} // namespace tactus::bench
