// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/bench_row.hpp"

#include <cstdint>
#include <string>

namespace tactus::bench
{

/// Facts about a run, besides the machine.
struct RunFacts
{
    int core{-1}; ///< Core of all measurements; -1: not pinned.
    bool quick{false};
    std::vector<std::string> options; ///< Options that make this less than a full run, as given.
};

enum class Figures : std::uint8_t
{
    all,
    with_goals,
};
/// One line for each row, below one for its case, and the number of goals met.
[[nodiscard]] std::string to_text(const Rows& rows, Figures which);

/// Report: {"schema":2,"commit","machine","core","quick","options","compiler","rows":[...]}, and
/// "failures" if there are any.
[[nodiscard]] std::string to_json(const Results& results, const RunFacts& facts);

} // namespace tactus::bench
