// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/test_model.hpp"
#include "tests/shared/trial_figures.hpp"

namespace tactus::test
{

/// Frames that see the base mesh only, each at the vertex of the source that is farthest from the
/// face of the base mesh that is nearest to it: one a face. The true distance is 0, so a face's
/// bound that is too small makes L > 0, unless another face's covers the point.
[[nodiscard]] TrialFigures query_worst_points(const TestModel& model);

} // namespace tactus::test
