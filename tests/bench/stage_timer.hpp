// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_input.hpp"
#include "tests/bench/measuring.hpp"

#include <array>
#include <numeric>

namespace tactus::bench
{

/// Measures the time at the end of each stage.
class StageTimer
{
public:
    void begin() { last_ = BenchClock::now(); }
    [[nodiscard]] StageMark mark() { return {&end_stage, this}; }
    [[nodiscard]] double us(Stage stage) const { return us_[static_cast<std::size_t>(stage)]; }
    [[nodiscard]] double sum_us() const { return std::accumulate(us_.begin(), us_.end(), 0.0); }

private:
    // Reads a clock, nothing else.
    TACTUS_TRUSTED_BEGIN
    static void end_stage(void* context, Stage stage) noexcept TACTUS_NONBLOCKING
    {
        StageTimer& timer = *static_cast<StageTimer*>(context);
        const BenchClock::time_point now = BenchClock::now();
        timer.us_[static_cast<std::size_t>(stage)] = microseconds(timer.last_, now);
        timer.last_ = now;
    }
    TACTUS_TRUSTED_END

    std::array<double, kStages> us_{};
    BenchClock::time_point last_;
};

} // namespace tactus::bench
