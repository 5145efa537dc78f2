// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/shape_scenes.hpp"
#include "tests/shared/trial_figures.hpp"

#include <array>

namespace tactus::test
{

/// Kernel of a shape and a triangle, compared with an oracle in long double, and in 113 bits where
/// long double is not certain.
struct KernelTrial
{
    const char* name;
    /// Runs pairs of one class. The error is the distance's, relative to the kernel's error law.
    /// Violations are an error or a distance_error above the law, numbers that are not finite,
    /// points off their shapes by more than the law and a rounding, and a gap that is not between
    /// them.
    TrialFigures (*run)(const PairClass& kind, int cases, Random& random);
};

inline constexpr std::size_t kKernelTrials = 6;
/// Trials of point, segment, triangle, box, sphere and capsule.
[[nodiscard]] const std::array<KernelTrial, kKernelTrials>& kernel_trials();

} // namespace tactus::test
