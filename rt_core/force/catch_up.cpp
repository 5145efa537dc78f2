// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/catch_up.hpp"

namespace tactus
{

Vec3 CatchUp::next(const Wish& wish) noexcept
{
    if (wish.has_waited)
    {
        lag_ = sent_ + wish.by_hand - wish.wanted;
    }
    const double lag = lag_.norm();
    const double step = wish.rate_per_s * wish.elapsed_s;
    if (!(lag > step))
    {
        follow(wish.wanted);
        return sent_;
    }
    lag_ *= 1.0 - step / lag;
    sent_ = wish.wanted + lag_;
    const double against = sent_.dot(wish.outward);
    if (against < 0.0)
    {
        sent_ -= wish.outward * (against / wish.outward.squaredNorm());
        lag_ = sent_ - wish.wanted;
    }
    return sent_;
}

} // namespace tactus
