// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/bench_options.hpp"
#include "tests/bench/bench_row.hpp"
#include "tests/bench/failure.hpp"
#include "tests/bench/scenes.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace tactus::bench
{

/// No goal for this figure.
inline constexpr double kNoGoal = std::numeric_limits<double>::infinity();
[[nodiscard]] inline std::optional<double> goal_if(double goal)
{
    return goal < kNoGoal ? std::optional(goal) : std::nullopt;
}

/// Inputs of every case, and the destination of its rows. A case throws a Failure if it cannot be
/// run or gives wrong answers; a missed goal is a row, not a failure.
struct CaseContext
{
    const char* suite;
    const std::string& name;
    const BenchOptions& options;
    SceneStore& scenes;
    Rows& rows;

    /// Common fields of this case's rows, with the suite's part if it has any.
    [[nodiscard]] Row common_row(const std::string& scene, const char* part = "") const;
};

struct Case
{
    std::string name;
    When when;
    std::function<void(const CaseContext&)> run;
};
template <typename Parameters>
[[nodiscard]] Case make_case(std::string name, When when,
                             void (*run)(const CaseContext&, const Parameters&),
                             const Parameters& parameters)
{
    return {std::move(name), when,
            [run, parameters](const CaseContext& context) { run(context, parameters); }};
}

/// Goals in microseconds.
struct FrameCase
{
    SceneSource scene;
    double speed_diag_per_s;
    std::uint32_t splits;   ///< Limit K of splits and of merges.
    std::size_t pool_bytes; ///< Pools including tables, inbox and the loader's copies.
    double p50, p99, max;
    double cold_max{kNoGoal};
    /// Goals for T_R + T_B, in instructions.
    double counted_p99{kNoGoal}, counted_max{kNoGoal};
    double counted_mean{kNoGoal}; ///< Goal for the mean of whole frames, in instructions.
};
/// A tool slides over a streamed model. Measures T_L + T_R + T_B + T_Q, warm, cold and with warmed
/// caches, and with --instructions those of a frame and of T_R + T_B.
void run_frame_case(const CaseContext& context, const FrameCase& test_case);

/// Goal in MiB.
struct MemoryCase
{
    SceneSource scene;
    double speed_diag_per_s;
    std::uint32_t splits;
    double pool_mib;
};
/// Finds the smallest of a series of pools with which a slide has an exact answer in every frame in
/// contact.
void run_memory_case(const CaseContext& context, const MemoryCase& test_case);

/// Goals as shares of the peer's time.
struct StaticCase
{
    SceneSource scene;
    double near_p50{kNoGoal}, near_p99{kNoGoal};
    double flight_p99{kNoGoal};
    double warmed_p99{kNoGoal}; ///< Goal as a share of our own warm p99.
};
/// Queries of the touching motion against a fully refined model, compared with the peers.
void run_static_case(const CaseContext& context, const StaticCase& test_case);

struct GrowthCase
{
    double growth; ///< Goal for p50 with the most faces divided by p50 with the fewest.
};
/// The same near queries on four sizes of the bumpy sphere.
void run_growth_case(const CaseContext& context, const GrowthCase& test_case);

} // namespace tactus::bench
