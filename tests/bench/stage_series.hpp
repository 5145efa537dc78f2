// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/bench_row.hpp"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace tactus::bench
{

/// T_L, T_R, T_B and T_Q.
inline constexpr std::size_t kSeriesStages = 4;

/// What each stage took over a case's first frames, in microseconds: a picture, no figure.
struct StageSeries
{
    static constexpr std::size_t kFramesMax = 2'000;
    static constexpr std::size_t kPointsMax = 600;

    std::string suite;
    std::string test_case;
    std::vector<double> frames; ///< The first one of each point.
    std::array<std::vector<double>, kSeriesStages> us;
};

/// Of one time a frame and stage, all of the same length: the first kFramesMax frames. More than
/// kPointsMax of them are taken together so many at a time, the frame with the largest sum standing
/// for the others, so that no peak is lost and a point is one frame.
[[nodiscard]] StageSeries make_series(const Row& common,
                                      const std::array<std::vector<double>, kSeriesStages>& us);

/// What suites have brought: rows, and beside them what only a picture shows.
struct Results
{
    Rows rows;
    std::vector<StageSeries> series;
    std::vector<std::string> failures; ///< A line for each suite that could not be run to its end.
};

} // namespace tactus::bench
