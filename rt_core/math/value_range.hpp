// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cmath>

namespace tactus
{

/// True for finite numbers above 0; below, of at least 0. False for infinity and NaN.
[[nodiscard]] inline bool is_positive(double value) noexcept
{
    return std::isfinite(value) && value > 0.0;
}
[[nodiscard]] inline bool is_not_negative(double value) noexcept
{
    return std::isfinite(value) && value >= 0.0;
}

} // namespace tactus
