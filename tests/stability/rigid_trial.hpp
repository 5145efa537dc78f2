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

/// What the object does meanwhile.
enum class RigidStage : std::uint8_t
{
    still,   ///< It stands in its model's frame.
    turning, ///< It turns to and fro about its middle by 0.3 rad/s at most, and sways.
    far,     ///< It stands 100 to 1,000 m away, turned, half to twice as large.
    closing, ///< Another one of its kind comes near it, and into it, and goes away, to and fro.
};

/// Frames of a tool that is held as a body, whose hand goes from place to place through and round
/// an object and turns.
struct RigidTrial
{
    SolidCore tool;
    const TestModel* object{nullptr};
    Material material;
    RigidStage stage{RigidStage::still};
    std::uint64_t seed{0};
    std::uint32_t frames{0};
};

struct RigidFigures
{
    /// Faces of the core that met the object's on the way of a frame, by exact arithmetic. A force
    /// or torque that is no number or too large is a violation as well, and so is one of a tool
    /// that touches nothing.
    TrialFigures crossings;
    /// Changes of force and torque in frames that say `squeezed`, and in the next ones, over what
    /// springs make of the hand's way and a proxy that waited may add.
    TrialFigures steps;
    /// Frames with such faces that are no violation: objects had left the tool no room and run over
    /// it, and the frame in which they did had said so (squeezed).
    std::uint64_t run_over{0};
    std::uint64_t squeezed{0};
    std::uint64_t contacts{0};
    std::uint64_t frozen{0};

    void add(const RigidFigures& other);
};

/// Pegs, plates, gears and needles on sockets, plates, gears and what tests have else; models are
/// made once a process.
[[nodiscard]] std::vector<RigidTrial> rigid_trials(RigidStage stage = RigidStage::still);

/// A core of each kind on each of the small_models().
[[nodiscard]] std::vector<RigidTrial> rigid_trials_on_small_models();
[[nodiscard]] RigidFigures run_rigid_trial(const RigidTrial& trial);

} // namespace tactus::test
