// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"

#include <algorithm>

namespace tactus
{

/// Aspect of a triangle (longest edge squared / twice the area) beyond which its normal is computed
/// in double-double and the error law grows no further. At 8, few triangles of a usual mesh need
/// that.
inline constexpr double kLargestAspect = 8.0;

/// Shares of the local length in the error law: for any triangle, and for each unit of aspect.
inline constexpr double kErrorShare = 4e-16;
inline constexpr double kErrorSharePerAspect = 1e-16;

/// The error law: a computed distance differs from the true one by at most this. `length` is the
/// local length: the longest of the triangle's edges and of the distances between its corners and
/// the other shape's. Lower bounds are lowered and upper bounds raised by it.
///
/// `aspect` is the triangle's aspect if its plane was used in double precision; kernels that decide
/// in double-double pass 0.
[[nodiscard]] constexpr double kernel_error(double aspect, double length) noexcept
{
    TACTUS_ASSERT(length >= 0.0);
    return (kErrorShare + kErrorSharePerAspect * std::min(aspect, kLargestAspect)) * length;
}

} // namespace tactus
