// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/bench_options.hpp"
#include "tests/bench/bench_row.hpp"
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

} // namespace tactus::bench
