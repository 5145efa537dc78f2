// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/shape_scenes.hpp"
#include "tests/shared/trial_figures.hpp"

#include <array>

namespace tactus::test
{

/// A kernel of a shape and a triangle, held against an oracle in long double, and in 113 bits where
/// long double can't tell.
struct KernelTrial
{
    const char* name;
    /// Pairs of one class. The error is the distance's, over the kernel's error law. Violations
    /// are that, a distance_error above the law, what is not finite, points off their shapes by
    /// more than the law and a rounding, and a gap that is not between them.
    TrialFigures (*run)(const PairClass& kind, int cases, Random& random);
};

inline constexpr std::size_t kKernelTrials = 6;
/// Point, segment, triangle, box, sphere, capsule.
[[nodiscard]] const std::array<KernelTrial, kKernelTrials>& kernel_trials();

} // namespace tactus::test
