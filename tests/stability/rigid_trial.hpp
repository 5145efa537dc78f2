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

/// Motion of the object.
enum class RigidStage : std::uint8_t
{
    still,   ///< Rests in its model frame.
    turning, ///< Rotates about its centre by at most 0.3 rad/s, to and fro, and sways.
    far,     ///< Is 100 to 1,000 m away, rotated, half to twice as large.
    closing, ///< Another object of its kind approaches, enters and leaves it repeatedly.
};

/// Frames of a rigid tool whose hand moves from place to place through and around an object and
/// rotates.
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
    /// Faces of the core that met the object's on a frame's path, by exact arithmetic. Violations
    /// are also a force or torque that is not finite or too large, and one of a tool without
    /// contact.
    TrialFigures crossings;
    /// Changes of force and torque in over-constrained frames and the next ones, beyond those of
    /// the springs over the hand's motion and of a proxy that waited.
    TrialFigures steps;
    /// Frames with such faces that are no violation: objects had run over the tool, and the frame
    /// reported it as over-constrained.
    std::uint64_t run_over{0};
    std::uint64_t over_constrained{0};
    std::uint64_t contacts{0};
    std::uint64_t halted{0};

    void add(const RigidFigures& other);
};

/// Pegs, plates, gears and needles on sockets, plates, gears and other models of the tests; models
/// are made once a process.
[[nodiscard]] std::vector<RigidTrial> rigid_trials(RigidStage stage = RigidStage::still);

/// One core of each kind on each of the small_models().
[[nodiscard]] std::vector<RigidTrial> rigid_trials_on_small_models();
[[nodiscard]] RigidFigures run_rigid_trial(const RigidTrial& trial);

} // namespace tactus::test
