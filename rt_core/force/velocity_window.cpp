// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/velocity_window.hpp"

#include "rt_core/base/assert.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

void VelocityWindow::add(const Vec3& position_m, double elapsed_s) noexcept
{
    TACTUS_ASSERT(elapsed_s > 0.0);
    count_ = std::min(count_ + 1, kVelocitySamples);
    for (std::uint32_t i = count_ - 1; i > 0; --i)
    {
        positions_m_[i] = positions_m_[i - 1];
        ages_s_[i] = ages_s_[i - 1] + elapsed_s;
    }
    positions_m_[0] = position_m;
    ages_s_[0] = 0.0;
}

Vec3 VelocityWindow::velocity_m_per_s() const noexcept
{
    Vec3 velocity(0.0, 0.0, 0.0);
    for (std::uint32_t last = 1; last < count_; ++last)
    {
        const Vec3 longer = (positions_m_[0] - positions_m_[last]) / ages_s_[last];
        if (!is_straight(last, longer))
        {
            break;
        }
        velocity = longer;
    }
    return velocity;
}

bool VelocityWindow::is_straight(std::uint32_t last, const Vec3& velocity) const noexcept
{
    for (std::uint32_t i = 1; i < last; ++i)
    {
        const Vec3 off = positions_m_[i] - (positions_m_[0] - velocity * ages_s_[i]);
        const bool is_on_it = std::abs(off.x()) <= quantum_m_ && std::abs(off.y()) <= quantum_m_ &&
                              std::abs(off.z()) <= quantum_m_;
        if (!is_on_it) // NaN counts as off the line.
        {
            return false;
        }
    }
    return true;
}

} // namespace tactus
