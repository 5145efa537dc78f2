// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/catch_up.hpp"

namespace tactus
{

Vec3 CatchUp::next(const Wish& wish) noexcept
{
    double step = wish.rate_per_s * wish.elapsed_s;
    if (wish.has_waited)
    {
        lag_ = sent_ - wish.wanted;
        step += wish.by_hand;
    }
    const double lag = lag_.norm();
    if (!(lag > step))
    {
        follow(wish.wanted);
        return sent_;
    }
    lag_ *= 1.0 - step / lag;
    sent_ = wish.wanted + lag_;
    const double length = sent_.norm();
    sent_ *= length > wish.longest ? wish.longest / length : 1.0;
    lag_ = sent_ - wish.wanted;
    return sent_;
}

} // namespace tactus
