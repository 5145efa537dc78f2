// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/measuring.hpp"

#include <algorithm>
#include <vector>

namespace tactus::bench
{

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
