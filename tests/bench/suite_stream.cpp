// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Suite `stream`: prediction, cache and transport for a hand on a model larger than the
/// controller's memory. Lists the cases with their goals.

#include "tests/bench/stream_cases.hpp"
#include "tests/bench/suites.hpp"

namespace tactus::bench
{

namespace
{

constexpr SceneSource kSmall{"small", nullptr, 0, 60'000};

std::vector<Case> stream_cases()
{
    const auto predict = [](const char* name, When when, const PredictionCase& test_case)
    { return make_case(name, when, run_prediction_case, test_case); };
    const auto tour = [](const char* name, When when, const TourCase& test_case)
    { return make_case(name, when, run_tour_case, test_case); };
    return {
        predict("0.1 diag/s, 20 ms", When::full_only, {kFineBunny, 0.1, 20, 2.2}),
        predict("0.5 diag/s, 5 ms", When::full_only, {kFineBunny, 0.5, 5, 2.2}),
        predict("0.5 diag/s, 20 ms", When::full_only, {kFineBunny, 0.5, 20, 2.2}),
        predict("0.5 diag/s, 20 ms, tremor", When::full_only, {kFineBunny, 0.5, 20, 2.2, 2e-4}),
        predict("0.5 diag/s, 50 ms", When::full_only, {kFineBunny, 0.5, 50, 4.5}),
        predict("2 diag/s, 5 ms", When::full_only, {kFineBunny, 2.0, 5, 4.5}),
        predict("2 diag/s, 20 ms", When::full_only, {kFineBunny, 2.0, 20, 4.5}),
        predict("2 diag/s, 20 ms, tremor", When::full_only, {kFineBunny, 2.0, 20, 4.5, 2e-4}),
        predict("predict-small", When::always, {kSmall, 0.5, 20, 1.0}),
        make_case("cache-1.1M", When::full_only, run_cache_case, CacheCase{kFineBunny, 1.0, 4.5}),
        make_case("cache-small", When::always, run_cache_case, CacheCase{kSmall, 0.5, 1.5}),
        tour("1.1M, 0.5 diag/s, loopback", When::full_only, {kFineBunny, 0.5, 2.2, -1.0}),
        tour("1.1M, 0.5 diag/s, 10 ms", When::full_only,
             {kFineBunny, 0.5, 2.2, 10.0, 0.0, 0.5, 0.0}),
        tour("1.1M, 0.5 diag/s, 10 ms, 1 % lost", When::full_only,
             {kFineBunny, 0.5, 2.2, 10.0, 0.01, 1.5, kNoGoal, 70.0}),
        tour("1.1M, 2 diag/s, 10 ms", When::full_only, {kFineBunny, 2.0, 4.5, 10.0, 0.0, 5.0}),
        tour("1.1M, 2 diag/s, 10 ms, 1 % lost", When::full_only,
             {kFineBunny, 2.0, 4.5, 10.0, 0.01, 6.0, kNoGoal, 70.0}),
        tour("small, 0.5 diag/s, loopback", When::always, {kSmall, 0.5, 1.0, -1.0}),
        make_case("first touch, 4.3M", When::full_only, run_first_touch_case,
                  FirstTouchCase{kFineIgea, 10.0, 150.0, 90.0}),
        make_case("throughput", When::full_only, run_throughput_case,
                  ThroughputCase{kFineBunny, 100.0}),
        make_case("8 clients, one stopped", When::full_only, run_fan_out_case,
                  FanOutCase{kFineBunny, 8, 100.0, true, 25.0}),
        make_case("64 clients", When::full_only, run_fan_out_case,
                  FanOutCase{kFineBunny, 64, 10.0, false}),
    };
}

} // namespace

Suite stream_suite()
{
    return {"stream", stream_cases};
}

} // namespace tactus::bench
