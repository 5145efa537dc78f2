// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/least_times.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::bench
{

double quantile(std::vector<double> values, double q)
{
    if (values.empty())
    {
        return std::numeric_limits<double>::quiet_NaN();
    }
    const double rank = std::ceil(q * static_cast<double>(values.size())) - 1.0;
    const auto place = static_cast<std::ptrdiff_t>(std::max(rank, 0.0));
    std::nth_element(values.begin(), values.begin() + place, values.end());
    return values[static_cast<std::size_t>(place)];
}

Spread spread_of(const std::vector<double>& values)
{
    return {quantile(values, 0.5), quantile(values, 0.99), quantile(values, 1.0)};
}

LeastTimes::LeastTimes(std::size_t frames) : least_(frames, std::numeric_limits<double>::infinity())
{
}

void LeastTimes::keep(std::size_t frame, double time)
{
    least_[frame] = std::min(least_[frame], time);
    raw_max_ = std::max(raw_max_, time);
}

std::vector<double> chosen(const std::vector<double>& values, const std::vector<bool>& choice)
{
    std::vector<double> kept;
    for (std::size_t i = 0; i < values.size(); ++i)
    {
        if (choice[i])
        {
            kept.push_back(values[i]);
        }
    }
    return kept;
}

} // namespace tactus::bench
