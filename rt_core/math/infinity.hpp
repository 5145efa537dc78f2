// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <limits>

// Any thread: a constant.
namespace tactus
{

/// An unknown distance, or no limit.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

} // namespace tactus
