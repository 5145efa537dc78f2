// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cmath>

namespace tactus
{

/// True for finite numbers in the range; false for infinity and NaN.
[[nodiscard]] inline bool is_positive(double value) noexcept
{
    return std::isfinite(value) && value > 0.0;
}
[[nodiscard]] inline bool is_not_negative(double value) noexcept
{
    return std::isfinite(value) && value >= 0.0;
}

} // namespace tactus
