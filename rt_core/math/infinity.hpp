// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <limits>

// Any thread: a constant.
namespace tactus
{

/// A distance that is not known, a limit that does not limit.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

} // namespace tactus
