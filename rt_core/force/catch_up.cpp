// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/catch_up.hpp"

namespace tactus
{

Vec3 CatchUp::next(const Command& commanded) noexcept
{
    double step = commanded.rate_per_s * commanded.elapsed_s;
    if (commanded.has_waited)
    {
        lag_ = sent_ - commanded.wanted;
        step += commanded.by_hand;
    }
    const double lag = lag_.norm();
    if (!(lag > step))
    {
        follow(commanded.wanted);
        return sent_;
    }
    lag_ *= 1.0 - step / lag;
    sent_ = commanded.wanted + lag_;
    const double length = sent_.norm();
    sent_ *= length > commanded.longest ? commanded.longest / length : 1.0;
    lag_ = sent_ - commanded.wanted;
    return sent_;
}

} // namespace tactus
