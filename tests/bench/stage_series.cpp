// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/stage_series.hpp"

#include <algorithm>

namespace tactus::bench
{

StageSeries make_series(const Row& common, const std::array<std::vector<double>, kSeriesStages>& us)
{
    StageSeries series{common.suite, common.test_case, {}, {}};
    const std::size_t frames = std::min(us[0].size(), StageSeries::kFramesMax);
    const std::size_t each = (frames + StageSeries::kPointsMax - 1) / StageSeries::kPointsMax;
    const auto sum_of = [&us](std::size_t frame)
    {
        double sum = 0.0;
        for (const std::vector<double>& stage : us)
        {
            sum += stage[frame];
        }
        return sum;
    };
    for (std::size_t first = 0; first < frames; first += each)
    {
        std::size_t largest = first;
        for (std::size_t frame = first; frame < std::min(first + each, frames); ++frame)
        {
            largest = sum_of(frame) > sum_of(largest) ? frame : largest;
        }
        series.frames.push_back(static_cast<double>(first));
        for (std::size_t stage = 0; stage < kSeriesStages; ++stage)
        {
            series.us.at(stage).push_back(us.at(stage)[largest]);
        }
    }
    return series;
}

} // namespace tactus::bench
