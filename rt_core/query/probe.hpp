// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/kernels/kernels.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/rounding.hpp"
#include "rt_core/math/vec3.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

/// Bound on the share of a coordinate that is lost when a double is split into two floats: 2^-48,
/// rounded up.
inline constexpr double kSplitRounding = 0x1p-46;
/// Least slack of a split place, in quanta, for coordinates near zero.
inline constexpr double kLeastSlack = 0x1p-40;

/// True if a coordinate is kFarQuanta or more from the origin.
[[nodiscard]] inline bool is_beyond_kernels(const Vec3& point_m, float quantum_m) noexcept
{
    const double limit_m = kFarQuanta * static_cast<double>(quantum_m);
    // Written so that NaN is beyond, too. maxCoeff() would call through a pointer, and NaN would
    // pass in some orders of coordinates.
    // NOLINTNEXTLINE(readability-simplify-boolean-expr): the simpler one lets NaN pass.
    return !(std::abs(point_m.x()) < limit_m && std::abs(point_m.y()) < limit_m &&
             std::abs(point_m.z()) < limit_m);
}

/// Makes a probe at `point_m` in the model's frame, which must not be beyond the kernels.
[[nodiscard]] inline KernelProbe make_probe(const Vec3& point_m, float quantum_m) noexcept
{
    KernelProbe probe{};
    double largest = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double value = point_m[axis];
        const auto high = static_cast<float>(value);
        probe.high[axis] = high;
        probe.low[axis] = static_cast<float>(value - static_cast<double>(high));
        largest = std::max(largest, std::abs(value));
    }
    probe.scale = 1.0F / quantum_m;
    probe.slack = round_up_to_float(largest * static_cast<double>(probe.scale) * kSplitRounding +
                                    kLeastSlack);
    return probe;
}

} // namespace tactus
