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
    , units_per_m_here_(static_cast<float>(units_per_m * there.place.scale))
    , slack_(slack)
{
    TACTUS_ASSERT(units_per_m > 0.0);
    TACTUS_ASSERT(slack >= 0.0F);
    for (std::size_t along = 0; along < 3; ++along)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const double share = there.place.rotation(static_cast<Eigen::Index>(axis),
                                                      static_cast<Eigen::Index>(along));
            axes_[along][axis] = static_cast<float>(share);
            sizes_[along][axis] = std::abs(axes_[along][axis]);
        }
    }
}

/// Places a box: its centre in double precision, as it is far from the origin, and its extents in
/// single precision, with a rounding of less than kPairMargin of them.
KernelBox BoxView::of(const Aabb& box) const noexcept
{
    const Vec3 center = there_.local_to_world(0.5 * (to_vec3(box.low) + to_vec3(box.high)));
    KernelBox seen; // NOLINT(cppcoreguidelines-pro-type-member-init): all of it is set below.
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        seen.half_along[axis] = (0.5F * units_per_m_here_) * (box.high[axis] - box.low[axis]);
    }
    float sum = 0.0F;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const double at = center[static_cast<Eigen::Index>(axis)];
        const auto high = static_cast<float>(at);
        seen.center.high[axis] = high;
        seen.center.low[axis] = static_cast<float>(at - static_cast<double>(high));
        seen.half[axis] = sizes_[0][axis] * seen.half_along[0] +
                          sizes_[1][axis] * seen.half_along[1] +
                          sizes_[2][axis] * seen.half_along[2];
        for (std::size_t along = 0; along < 3; ++along)
        {
            seen.axes[along][axis] = axes_[along][axis];
        }
        sum += seen.half[axis] + seen.half_along[axis];
    }
    seen.center.scale = static_cast<float>(units_per_m_);
    seen.center.slack = sum * kPairMargin + slack_;
    return seen;
}

} // namespace tactus
