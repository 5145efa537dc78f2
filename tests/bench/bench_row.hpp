// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tactus::bench
{

/// The seed of every noise and motion here; it stands in the rows.
inline constexpr std::uint64_t kSeed = 2026;

/// One figure of one case. All suites use the same rows.
struct Row
{
    std::string suite;
    std::string part; ///< Of the suite; empty when it has only one.
    std::string test_case;
    std::string by;      ///< Whose figure it is; empty when all are ours.
    std::string setting; ///< Of what a case varies, e.g. "K 64"; empty: it varies nothing.
    std::string metric;
    double value{0.0};
    std::string unit;
    std::string scene;
    std::uint64_t seed{0};
    std::uint64_t frames{0};
    std::uint64_t hash{0};      ///< Over the frames: the same work was measured.
    std::optional<double> goal; ///< The value is to be this at most,
    bool is_least{false};       ///< or at least.
    std::optional<std::string> peer;
    double peer_value{0.0};

    /// True without a goal; false for a value that is not a number.
    [[nodiscard]] bool is_met() const
    {
        return !goal || (is_least ? value >= *goal : value <= *goal);
    }
};

using Rows = std::vector<Row>;

/// What all rows of one case have in common, and the way to add them.
class CaseRows
{
public:
    CaseRows(Rows& rows, Row common) : rows_(rows), common_(std::move(common)) {}

    /// The reference is valid until the next row is added.
    Row& add(const std::string& metric, double value, const std::string& unit,
             std::optional<double> goal = std::nullopt);

private:
    Rows& rows_;
    Row common_;
};

/// How many rows have a goal, and how many of those hold it.
struct GoalCount
{
    std::size_t goals{0};
    std::size_t met{0};
};
[[nodiscard]] GoalCount count_goals(const Rows& rows);

/// What suites have brought.
struct Results
{
    Rows rows;
    std::vector<std::string> failures; ///< A line for each suite that could not be run to its end.
};

} // namespace tactus::bench
