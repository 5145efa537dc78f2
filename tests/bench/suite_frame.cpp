// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Suite `frame`: the goals' table. Lists the cases with their goals; the cases' own files measure
/// them.

#include "tests/bench/measuring.hpp"
#include "tests/bench/suites.hpp"

namespace tactus::bench
{

namespace
{

void run_clock_case(const CaseContext& context)
{
    CaseRows(context.rows, context.common_row("none")).add("two readings", clock_cost_us(), "us");
}

/// Rows of the goals' table, in order.
std::vector<Case> frame_cases()
{
    const auto frame = [](const char* name, When when, const FrameCase& test_case)
    { return make_case(name, when, run_frame_case, test_case); };
    return {
        {"clock", When::always, run_clock_case},
        frame("bunny-0.1", When::always, {kBunny, 0.1, 64, 2 * kMiB, 1.0, 4.0, 12.0}),
        frame("bunny-2", When::always, {kBunny, 2.0, 64, 2 * kMiB, 4.0, 23.0, 25.0}),
        frame("1.1M-0.5", When::always,
              {kFineBunny, 0.5, 64, 4 * kMiB, 9.0, 28.0, 45.0, 120.0, 145e3, 200e3, 125e3}),
        frame("1.1M-2", When::always, {kFineBunny, 2.0, 128, 4 * kMiB, 25.0, 90.0, 125.0}),
        frame("4.3M-0.5", When::full_only,
              {kFineIgea, 0.5, 128, 8 * kMiB, 30.0, 80.0, 90.0, 250.0}),
        make_case("memory-4.3M", When::full_only, run_memory_case,
                  MemoryCase{kFineIgea, 0.1, 128, 4.0}),
        make_case("static-bunny", When::always, run_static_case,
                  StaticCase{kBunny, 0.6, 0.45, 0.3, 2.0}),
        make_case("static-4.3M", When::full_only, run_static_case,
                  StaticCase{kFineIgea, 0.2, 0.15, 0.3, 2.0}),
        make_case("static-growth", When::full_only, run_growth_case, GrowthCase{3.0}),
        frame("frame-tiny", When::named_only,
              {kTiny, 0.1, 64, kMiB, kNoGoal, kNoGoal, kNoGoal, kNoGoal}),
        make_case("static-tiny", When::named_only, run_static_case, StaticCase{kTiny}),
    };
}

} // namespace

Suite frame_suite()
{
    return {"frame", frame_cases, false, Figures::with_goals};
}

} // namespace tactus::bench
