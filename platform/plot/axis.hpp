// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tactus::plot
{

/// Where an axis is marked, and with what.
struct Tick
{
    double share{0.0}; ///< Of the axis, 0 to 1.
    std::string text;
};

/// How values lie along one side of a plot: evenly, or by their logarithm. A logarithm has no
/// place for zero: an axis that needs one has a column of its own for it in front.
class Axis
{
public:
    /// Holds 0 and both values, finite ones; its ends are round.
    [[nodiscard]] static Axis linear(double least, double most);
    /// Holds both values, 0 < least <= most; its ends are 1, 2 or 5 times a power of ten.
    [[nodiscard]] static Axis logarithmic(double least, double most, bool has_zero = false);
    /// From `least` > 0, which need not be round, to `most` > least.
    [[nodiscard]] static Axis exactly(double least, double most);
    /// What holds all values that are finite and, by the logarithm, not negative; others count not.
    [[nodiscard]] static Axis fitted(const std::vector<double>& values, bool is_logarithmic);

    /// Where the value is, 0 to 1; beyond the ends, at the end.
    [[nodiscard]] double share(double value) const;
    /// Strictly between the ends.
    [[nodiscard]] bool holds(double value) const;
    /// Whether the value has a place at all: finite, and on a logarithmic axis not negative, nor
    /// zero unless that has its column.
    [[nodiscard]] bool can_show(double value) const;
    /// Where the column of zero ends; 0 when there is none.
    [[nodiscard]] double zero_share() const { return zero_share_; }
    /// At least two; about `most` of them unless the range needs fewer.
    [[nodiscard]] std::vector<Tick> ticks(std::size_t most) const;

private:
    Axis(bool is_logarithmic, double least, double most, double zero_share)
        : is_logarithmic_(is_logarithmic), least_(least), most_(most), zero_share_(zero_share)
    {
    }
    [[nodiscard]] std::vector<Tick> even_ticks(std::size_t most) const;
    [[nodiscard]] std::vector<Tick> decade_ticks(std::size_t most) const;

    bool is_logarithmic_;
    double least_; ///< The ends: values, or their common logarithms.
    double most_;
    double zero_share_;
};

/// "12 500", "0.02", "10^-6" in raised digits: as short as the value's own digits allow, at most
/// three of them behind the first that is not zero.
[[nodiscard]] std::string number_text(double value);

} // namespace tactus::plot
