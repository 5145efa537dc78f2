// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <vector>

namespace tactus::bench
{

/// q-quantile (0 .. 1) by nearest rank, always one of the values. NaN without values.
[[nodiscard]] double quantile(std::vector<double> values, double q);

struct Spread
{
    double p50{0.0};
    double p99{0.0};
    double max{0.0};
};
[[nodiscard]] Spread spread_of(const std::vector<double>& values);

/// Least time of each frame over repeated replays. This removes delays by the machine's scheduler;
/// the greatest single time shows their size.
class LeastTimes
{
public:
    explicit LeastTimes(std::size_t frames = 0);

    void keep(std::size_t frame, double time);

    [[nodiscard]] const std::vector<double>& least() const { return least_; }
    [[nodiscard]] double raw_max() const { return raw_max_; }

private:
    std::vector<double> least_; ///< Infinity before the first replay.
    double raw_max_{0.0};
};

/// Values of the chosen frames.
[[nodiscard]] std::vector<double> chosen(const std::vector<double>& values,
                                         const std::vector<bool>& choice);

} // namespace tactus::bench
