// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/cases.hpp"

#include <cstdint>

namespace tactus::bench
{

/// Proxy speed limit of all tours, relative to the tour's speed.
inline constexpr double kTourFollow = 1.5;

/// Splits and merges of a tour's frames.
[[nodiscard]] constexpr std::uint32_t tour_splits(double speed_diag_per_s)
{
    return speed_diag_per_s < 1.0 ? 64 : 128;
}

struct PredictionCase
{
    SceneSource scene;
    double speed_diag_per_s;
    std::uint32_t latency_ms;
    double cache_mib;
    double tremor_diag{0.0};
};
/// A tour with each prediction method, in virtual time.
void run_prediction_case(const CaseContext& context, const PredictionCase& test_case);

struct CacheCase
{
    SceneSource scene;
    double small_mib;
    double larger_mib;
};
/// The four regimes of figure 5 of the 3DIM 2005 paper: no cache, a small one, a larger one, the
/// whole model.
void run_cache_case(const CaseContext& context, const CacheCase& test_case);

/// Goals in percent of the frames, counts and milliseconds.
struct TourCase
{
    SceneSource scene;
    double speed_diag_per_s;
    double cache_mib;
    double delay_ms; ///< Delay each way; negative: loopback.
    double loss{0.0};
    double open_max{kNoGoal};
    double late_taps_max{kNoGoal};
    double arrival_p99_ms{kNoGoal};
};
/// A tour with the whole programs spm_publish and hrtc over DDS.
void run_tour_case(const CaseContext& context, const TourCase& test_case);

struct FirstTouchCase
{
    SceneSource scene;
    double delay_ms;
    double payload_kb{kNoGoal};
    double time_ms{kNoGoal};
};
/// Whole programs: hrtc starts in touch, with only the model's header and base mesh.
void run_first_touch_case(const CaseContext& context, const FirstTouchCase& test_case);

struct ThroughputCase
{
    SceneSource scene;
    double mb_per_s;
};
/// spm_publish and one client on loopback, as fast as chunks arrive.
void run_throughput_case(const CaseContext& context, const ThroughputCase& test_case);

struct FanOutCase
{
    SceneSource scene;
    std::uint32_t clients;
    double rate_hz;
    bool stops_one; ///< One client is stopped halfway, like by SIGSTOP.
    double p99_ms{kNoGoal};
};
/// spm_publish and many clients on loopback, each at a rate.
void run_fan_out_case(const CaseContext& context, const FanOutCase& test_case);

} // namespace tactus::bench
