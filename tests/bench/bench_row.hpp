// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tactus::bench
{

/// Seed of every noise and motion in this program; reported in the rows.
inline constexpr std::uint64_t kSeed = 2026;

/// One figure of one case, the same for all suites.
struct Row
{
    std::string suite;
    std::string part; ///< Part of the suite; empty if it has only one.
    std::string test_case;
    std::string by;      ///< Library that is measured; empty if all figures are ours.
    std::string setting; ///< Value of the parameter that a case varies, e.g. "K 64"; empty: none.
    std::string metric;
    double value{0.0};
    std::string unit;
    std::string scene;
    std::uint64_t seed{0};
    std::uint64_t frames{0};
    std::uint64_t hash{0};      ///< Hash of the frames, to show that the same work was measured.
    std::optional<double> goal; ///< Greatest allowed value, or least one if `is_least`.
    bool is_least{false};
    std::optional<std::string> peer;
    double peer_value{0.0};

    /// True without a goal; false for a value that is not a number.
    [[nodiscard]] bool is_met() const
    {
        return !goal || (is_least ? value >= *goal : value <= *goal);
    }
};

using Rows = std::vector<Row>;

/// Common fields of all rows of one case, and the way to add rows.
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

/// Number of rows with a goal, and of those that meet it.
struct GoalCount
{
    std::size_t goals{0};
    std::size_t met{0};
};
[[nodiscard]] GoalCount count_goals(const Rows& rows);

struct Results
{
    Rows rows;
    std::vector<std::string> failures; ///< One line for each suite that did not complete.
};

} // namespace tactus::bench
