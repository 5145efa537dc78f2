// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

#include "tests/bench/measuring.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

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

double clock_cost_us()
{
    std::vector<double> costs;
    for (int i = 0; i < 1'000; ++i)
    {
        const BenchClock::time_point start = BenchClock::now();
        costs.push_back(microseconds(start, BenchClock::now()));
    }
    std::nth_element(costs.begin(), costs.begin() + 500, costs.end());
    return costs[500];
}

bool may_use_core(int core)
{
    cpu_set_t allowed{};
    return core >= 0 && core < CPU_SETSIZE &&
           ::sched_getaffinity(0, sizeof(allowed), &allowed) == 0 &&
           CPU_ISSET(static_cast<std::size_t>(core), &allowed);
}

PinnedCore::PinnedCore(int core)
{
    if (::sched_getaffinity(0, sizeof(before_), &before_) != 0)
    {
        return;
    }
    for (int i = 0; core < 0 && i < CPU_SETSIZE; ++i)
    {
        core_ = may_use_core(i) ? i : core_;
    }
    core_ = core < 0 ? core_ : core;
    cpu_set_t one{};
    CPU_SET(static_cast<std::size_t>(std::max(core_, 0)), &one);
    if (::sched_setaffinity(0, sizeof(one), &one) != 0)
    {
        core_ = -1;
    }
}

PinnedCore::~PinnedCore()
{
    if (core_ >= 0)
    {
        ::sched_setaffinity(0, sizeof(before_), &before_);
    }
}

void CacheEvictor::evict()
{
    for (std::size_t i = 0; i < bytes_.size(); i += 64)
    {
        volatile unsigned char& byte = bytes_[i];
        byte = static_cast<unsigned char>(byte + 1);
    }
}

} // namespace tactus::bench
