// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/separations.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/geometry/gjk.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tactus
{

namespace
{

/// Smallest value of the row at the places in `used`, one bit each.
double least(const CornersAtCore::Row& row, std::uint32_t used) noexcept
{
    double found = kInfinity;
    for (; used != 0; used &= used - 1)
    {
        found = std::min(found, row[static_cast<std::size_t>(std::countr_zero(used))]);
    }
    return found;
}
double greatest(const CornersAtCore::Row& row, std::uint32_t used) noexcept
{
    double found = 0.0;
    for (; used != 0; used &= used - 1)
    {
        found = std::max(found, row[static_cast<std::size_t>(std::countr_zero(used))]);
    }
    return found;
}

} // namespace

// NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): heights are read after bound_all() alone.
Separations::Separations(const PlacedCore& core) noexcept : core_(core), body_(core.body()) {}

double Separations::bound_all(const std::array<CornerRow, 3>& corners, std::uint32_t used,
                              const CornersAtCore& seen, double enough) noexcept
{
    TACTUS_ASSERT(used != 0 && used >> CornersAtCore::kCorners == 0);
    const double farthest = std::sqrt(greatest(seen.beyond_sq, used)) + core_.half().norm();
    rounding_ = kGjkRounding * (farthest + body_.radius);
    corners_ = &corners;
    double best = -kInfinity;
    for (measured_ = 0; measured_ < count_ && best <= enough; ++measured_)
    {
        measure(measured_);
        best = std::max(best, least(heights_[measured_], used) - rounding_);
    }
    return best;
}

double Separations::bound(const std::array<std::uint8_t, 3>& triangle) const noexcept
{
    double best = -kInfinity;
    for (std::size_t i = 0; i < measured_; ++i)
    {
        const CornersAtCore::Row& heights = heights_[i];
        best = std::max(
            best, std::min({heights[triangle[0]], heights[triangle[1]], heights[triangle[2]]}));
    }
    return best - rounding_;
}

void Separations::add(const Vec3& direction) noexcept
{
    TACTUS_ASSERT(corners_ != nullptr);
    TACTUS_ASSERT(measured_ == count_);
    const std::size_t place = count_ < kDirections ? count_++ : oldest_++ % kDirections;
    directions_[place] = {direction, direction.dot(body_.support(body_.context, direction))};
    measure(place);
    measured_ = count_;
}

void Separations::measure(std::size_t direction) noexcept
{
    const Direction& along = directions_[direction];
    CornersAtCore::Row& heights = heights_[direction];
    heights = heights_along(along.way, *corners_, core_.center());
    for (double& height : heights)
    {
        height -= along.reach;
    }
}

} // namespace tactus
