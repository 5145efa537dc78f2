// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/random.hpp"
#include "tests/shared/trial_figures.hpp"
#include "tests/stability/hardships.hpp"

#include <cstdint>
#include <vector>

namespace tactus::test
{

/// Frames of a scene whose objects are added, moved and removed while tools wander through it, are
/// added and removed, with changes among them that must be refused. It restarts every few hundred
/// frames, one time in four with the frame as it ships, otherwise with a random set of its
/// shortcuts.
struct SceneTrial
{
    std::vector<const TestModel*> models; ///< Models of the objects; the first gives the scale.
    Hardship hardship;
    std::uint32_t tools{3};
    std::uint64_t seed{0};
    std::uint32_t frames{0};
};

struct SceneFigures
{
    /// Every pair of bounds and every clearance holds the distance found by trying all objects; the
    /// pairs are in order; every refused change is counted and has no effect. The error is a
    /// distance's excess over the reported bounds, relative to the allowed rounding.
    TrialFigures truth;
    std::uint64_t exact{0};
    std::uint64_t refused{0};
    std::uint64_t gone{0};     ///< Absent tools, summed over the frames.
    std::uint64_t variants{0}; ///< Starts without some shortcut.

    void add(const SceneFigures& other)
    {
        truth.add(other.truth);
        exact += other.exact;
        refused += other.refused;
        gone += other.gone;
        variants += other.variants;
    }
};

[[nodiscard]] SceneFigures run_scene_trial(const SceneTrial& trial);

/// Random variant: each shortcut with probability 1/2.
[[nodiscard]] FrameVariant any_variant(Random& random);

/// Random pose in a cube of the world with any rotation and a scale of 0.5 to 1.5.
[[nodiscard]] ObjectPose any_pose(Random& random, double world_m);

} // namespace tactus::test
