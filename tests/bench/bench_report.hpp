// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/bench_row.hpp"

#include <cstdint>
#include <string>

namespace tactus::bench
{

/// How the rows came about, beside the machine.
struct RunFacts
{
    int core{-1}; ///< The one that everything was measured on; -1: not held to one.
    bool quick{false};
    std::vector<std::string> options; ///< Those that make it another than a full run, as given.
};

enum class Figures : std::uint8_t
{
    all,
    with_goals,
};
/// A line for each row below one for its case, and how many goals were met.
[[nodiscard]] std::string to_text(const Rows& rows, Figures which);

/// {"schema":2,"commit","machine","core","quick","options","compiler","rows":[...]}, and "failures"
/// when there are any.
[[nodiscard]] std::string to_json(const Results& results, const RunFacts& facts);

} // namespace tactus::bench
