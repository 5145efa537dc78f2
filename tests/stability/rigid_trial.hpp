// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/object_pose.hpp"
#include "tests/shared/solid_cores.hpp"
#include "tests/shared/trial_figures.hpp"

#include <cstdint>
#include <vector>

namespace tactus::test
{

/// Frames of a tool that is held as a body, whose hand goes from place to place through and round
/// an object and turns.
struct RigidTrial
{
    SolidCore tool;
    const TestModel* object{nullptr};
    Material material;
    std::uint64_t seed{0};
    std::uint32_t frames{0};
};

struct RigidFigures
{
    /// Faces of the core that met the object's on the way of a frame, by exact arithmetic.
    TrialFigures crossings;
    std::uint64_t contacts{0};
    std::uint64_t frozen{0};

    void add(const RigidFigures& other);
};

/// Pegs, plates, gears and needles on sockets, plates, gears and what tests have else; models are
/// made once a process.
[[nodiscard]] std::vector<RigidTrial> rigid_trials();

[[nodiscard]] RigidFigures run_rigid_trial(const RigidTrial& trial);

} // namespace tactus::test
