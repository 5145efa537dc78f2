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

/// How values lie along one side of a plot: evenly, or by their logarithm.
class Axis
{
public:
    /// From 0 to a round number that is not below `most` >= 0.
    [[nodiscard]] static Axis linear(double most);
    /// From `least` > 0, which need not be round, to `most` > least.
    [[nodiscard]] static Axis exactly(double least, double most);

    /// Where the value is, 0 to 1; beyond the ends, at the end.
    [[nodiscard]] double share(double value) const;
    /// Strictly between the ends.
    [[nodiscard]] bool holds(double value) const;
    /// At least two; about `most` of them unless the range needs fewer.
    [[nodiscard]] std::vector<Tick> ticks(std::size_t most) const;

private:
    Axis(bool is_logarithmic, double least, double most)
        : is_logarithmic_(is_logarithmic), least_(least), most_(most)
    {
    }
    [[nodiscard]] std::vector<Tick> even_ticks(std::size_t most) const;
    [[nodiscard]] std::vector<Tick> decade_ticks(std::size_t most) const;

    bool is_logarithmic_;
    double least_; ///< The ends: values, or their common logarithms.
    double most_;
};

/// "12 500", "0.02", "10^-6" in raised digits: as short as the value's own digits allow, at most
/// three of them behind the first that is not zero.
[[nodiscard]] std::string number_text(double value);

} // namespace tactus::plot
