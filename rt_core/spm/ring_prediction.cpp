// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/spm/ring_prediction.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/rounding.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tactus
{

namespace
{

/// Quotient rounded to the nearest, halves up; `divisor` > 0.
std::int64_t divide(std::int64_t value, std::int64_t divisor) noexcept
{
    TACTUS_ASSERT(divisor > 0);
    const std::int64_t twice = 2 * value + divisor;
    const std::int64_t quotient = twice / (2 * divisor);
    return quotient - (twice % (2 * divisor) < 0 ? 1 : 0);
}

} // namespace

RingPrediction::RingPrediction(std::span<const GridPosition> ring) noexcept
{
    TACTUS_ASSERT(ring.size() >= 3);
    TACTUS_ASSERT(ring.size() <= kMaxFanFaces + 2);
    const auto count = static_cast<std::int64_t>(ring.size());
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        std::int64_t sum = 0;
        for (const GridPosition& vertex : ring)
        {
            sum += vertex[axis];
        }
        mean_[axis] = static_cast<std::int32_t>(divide(sum, count));
    }
    const auto from_mean = [&](std::size_t i, std::size_t axis)
    { return std::int64_t{ring[i][axis]} - mean_[axis]; };
    for (std::size_t i = 0; i < ring.size(); ++i)
    {
        const std::size_t j = i + 1 < ring.size() ? i + 1 : 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const std::size_t a = (axis + 1) % 3;
            const std::size_t b = (axis + 2) % 3;
            normal_[axis] += from_mean(i, a) * from_mean(j, b) - from_mean(i, b) * from_mean(j, a);
        }
    }
    for (std::size_t axis = 0; axis < 2; ++axis)
    {
        axis_ = std::abs(normal_[axis]) > std::abs(normal_[axis_]) ? axis : axis_;
    }
    outward_ = normal_[axis_] < 0 ? -1 : 1;
    // The normal has at most 30 bits, so that products with coordinates fit.
    const auto width =
        static_cast<int>(std::bit_width(static_cast<std::uint64_t>(std::abs(normal_[axis_]))));
    for (std::int64_t& component : normal_)
    {
        component /= std::int64_t{1} << std::max(width - 30, 0);
    }
}

/// Height of the plane above the mean at these other two coordinates, relative to the mean.
std::int64_t RingPrediction::height_at(std::int64_t first, std::int64_t second) const noexcept
{
    const std::int64_t normal = std::abs(normal_[axis_]);
    const std::int64_t sum = normal_[(axis_ + 1) % 3] * first + normal_[(axis_ + 2) % 3] * second;
    return normal == 0 ? 0 : divide(-outward_ * sum, normal);
}

std::array<std::int32_t, 3> RingPrediction::residual_of(const GridPosition& v) const noexcept
{
    const std::size_t a = (axis_ + 1) % 3;
    const std::size_t b = (axis_ + 2) % 3;
    const std::int32_t first = v[a] - mean_[a];
    const std::int32_t second = v[b] - mean_[b];
    const std::int64_t above = v[axis_] - mean_[axis_] - height_at(first, second);
    return {first, second, static_cast<std::int32_t>(outward_ * above)};
}

GridPosition RingPrediction::position_of(const std::array<std::int32_t, 3>& residual) const noexcept
{
    GridPosition v{};
    v[(axis_ + 1) % 3] = mean_[(axis_ + 1) % 3] + residual[0];
    v[(axis_ + 2) % 3] = mean_[(axis_ + 2) % 3] + residual[1];
    v[axis_] = static_cast<std::int32_t>(mean_[axis_] + height_at(residual[0], residual[1]) +
                                         std::int64_t{outward_} * residual[2]);
    return v;
}

ErrorCode star_reach(const GridPosition& v, std::span<const GridPosition> ring,
                     ErrorCode largest_error) noexcept
{
    TACTUS_ASSERT(!ring.empty());
    std::int64_t farthest_sq = 0;
    for (const GridPosition& vertex : ring)
    {
        std::int64_t sum = 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const std::int64_t d = std::int64_t{vertex[axis]} - v[axis];
            sum += d * d;
        }
        farthest_sq = std::max(farthest_sq, sum);
    }
    // The factor covers the rounding of sum and root.
    return encode_error((std::sqrt(static_cast<double>(farthest_sq)) +
                         static_cast<double>(error_in_quanta(largest_error))) *
                        kRoundedUp);
}

} // namespace tactus
