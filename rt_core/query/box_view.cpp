// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/box_view.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/math/rounding.hpp"

#include <cmath>
#include <cstddef>

namespace tactus
{

BoxView::BoxView(const MeshPlacement& there, double units_per_m, float slack) noexcept
    : there_(there)
    , units_per_m_(units_per_m)
    , units_per_m_here_(units_per_m * there.place.scale)
    , slack_(slack)
{
    TACTUS_ASSERT(units_per_m > 0.0);
    TACTUS_ASSERT(slack >= 0.0F);
}

KernelBox BoxView::of(const Aabb& box) const noexcept
{
    const Vec3 low = to_vec3(box.low);
    const Vec3 high = to_vec3(box.high);
    const Vec3 center = there_.to_there(0.5 * (low + high));
    const Vec3 half = (0.5 * units_per_m_here_) * (high - low);
    KernelBox seen; // NOLINT(cppcoreguidelines-pro-type-member-init): all of it is set below.
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
        const auto at = static_cast<float>(center[axis]);
        seen.center.high[axis] = at;
        seen.center.low[axis] = static_cast<float>(center[axis] - static_cast<double>(at));
        double extent = 0.0;
        for (int along = 0; along < 3; ++along)
        {
            const double share = there_.place.rotation(axis, along);
            seen.axes[along][axis] = static_cast<float>(share);
            extent += std::abs(share) * half[along];
        }
        seen.half[axis] = static_cast<float>(extent);
        seen.half_along[axis] = static_cast<float>(half[axis]);
        sum += extent + half[axis];
    }
    seen.center.scale = static_cast<float>(units_per_m_);
    seen.center.slack = round_up_to_float(sum * static_cast<double>(kPairMargin)) + slack_;
    return seen;
}

} // namespace tactus
