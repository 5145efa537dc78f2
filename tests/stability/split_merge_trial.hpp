// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/test_model.hpp"
#include "tests/shared/trial_figures.hpp"

#include <cstdint>

namespace tactus::test
{

/// Random splits, each with its closure, and merges, in waves between base and source. After each
/// wave everything is merged: then hash, faces, records and tree must be those of the start. Counts
/// operations.
[[nodiscard]] TrialFigures run_split_merge_trial(const TestModel& model, std::uint64_t operations,
                                                 std::uint64_t seed);

} // namespace tactus::test
