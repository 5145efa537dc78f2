// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/cases.hpp"

#include <cstddef>
#include <optional>
#include <string>

namespace tactus::bench
{

/// What is asked of our own answers, not of the peers': exact to rounding, every touch told, none
/// made up, nothing on the heap.
inline constexpr double kOurError_diag = 1e-9;
[[nodiscard]] inline std::optional<double> our_goal(const std::string& by, double goal)
{
    return by.starts_with("Tactus") ? std::optional(goal) : std::nullopt;
}

/// One probe in the touching motion, asked of every contestant.
struct PeerTouchCase
{
    const char* part;
    SceneSource scene;
    const char* setting;
    std::optional<std::size_t> pool_bytes; ///< Of the streaming contestant; none: there is none.
};
/// The workloads W1 and W3: near frames with a band of two radii, flight without one, whether touch
/// is told, what building costs and holds.
void run_peer_touch_case(const CaseContext& context, const PeerTouchCase& test_case);

struct PeerMeshCase
{
    SceneSource scene;
};
/// The workload W2: a tool that is a mesh turns and slides through the surface.
void run_peer_mesh_case(const CaseContext& context, const PeerMeshCase& test_case);

} // namespace tactus::bench
