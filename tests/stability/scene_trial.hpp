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

/// Frames of a scene whose objects come, move and go while tools wander through it, come and go,
/// with changes among them that must be refused. Every few hundred frames it begins anew, one time
/// in four with the frame as it ships, else with any set of its shortcuts.
struct SceneTrial
{
    std::vector<const TestModel*> models; ///< That objects show; the first gives the scale.
    Hardship hardship;
    std::uint32_t tools{3};
    std::uint64_t seed{0};
    std::uint32_t frames{0};
};

struct SceneFigures
{
    /// Every bracket and every clearance holds the distance that is found by trying all objects;
    /// the pairs are in their order, every refused change is counted and changes nothing. The error
    /// is how far a distance is out of what was said, by the rounding that is allowed.
    TrialFigures truth;
    std::uint64_t exact{0};
    std::uint64_t refused{0};  ///< Changes.
    std::uint64_t gone{0};     ///< Tools that were not there, summed over the frames.
    std::uint64_t variants{0}; ///< Beginnings without some shortcut.

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

/// Each of a frame's shortcuts with 1 in 2.
[[nodiscard]] FrameVariant any_variant(Random& random);

/// Anywhere in a cube of the world, turned anyhow, of 0.5 to 1.5 times the size.
[[nodiscard]] ObjectPose any_pose(Random& random, double world_m);

} // namespace tactus::test
