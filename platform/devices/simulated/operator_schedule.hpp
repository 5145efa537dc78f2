// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <algorithm>
#include <cstdint>

namespace tactus
{

/// Schedule of the scripted operator. Times are shares of the run, so that short runs have all
/// phases. Flight and retreat together take less than a tenth of a run of 3 s.
struct OperatorSchedule
{
    double flight_s;
    std::uint64_t first_lift_frame;
    std::uint64_t lift_spacing_frames;
    std::uint32_t lifts;
    std::uint64_t retreat_frame;

    OperatorSchedule(double run_s, double period_s, bool lifts_off) noexcept
        : flight_s(std::clamp(0.04 * run_s, 0.1, 1.0))
        , first_lift_frame(frames_in(0.3 * run_s, period_s))
        , lifts(std::max(kLiftsMin, static_cast<std::uint32_t>(std::min(run_s / 2.5, 1e6))))
        , retreat_frame(frames_in(run_s - std::clamp(0.03 * run_s, 0.1, 0.5), period_s))
    {
        lift_spacing_frames = frames_in(0.5 * run_s / lifts, period_s) + 1;
        lifts = lifts_off ? lifts : 0;
    }

    [[nodiscard]] bool lift_is_due(std::uint64_t frame, std::uint32_t lifts_done) const noexcept
    {
        return lifts_done < lifts && frame >= first_lift_frame + lifts_done * lift_spacing_frames;
    }

    /// Number of frames; 0 for a negative time.
    [[nodiscard]] static std::uint64_t frames_in(double seconds, double period_s) noexcept
    {
        return static_cast<std::uint64_t>(std::max(seconds, 0.0) / period_s);
    }

private:
    static constexpr std::uint32_t kLiftsMin = 3;
};

} // namespace tactus
