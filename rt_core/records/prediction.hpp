// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// Methods that predict where a tool will touch: the four of the 3DIM 2005 paper, and the
/// choice among them. Recordings store the number, so adding one before `automatic` needs a new
/// version of that format (platform/recording/setup_coding.cpp).
enum class Prediction : std::uint8_t
{
    local_neighbours, ///< Fixed place; the present speed sets the radius that may be touched.
    linear,           ///< Straight on at the present velocity.
    quadratic,        ///< Present velocity and acceleration.
    distance_query,   ///< Straight on, but not through the surface of the last query.
    automatic,        ///< The one of these with the least recent error.
};
/// Number of methods that predict.
inline constexpr std::size_t kPredictions = 4;
static_assert(static_cast<std::size_t>(Prediction::automatic) == kPredictions);

/// Names in options and reports, in order.
inline constexpr std::array<std::string_view, kPredictions + 1> kPredictionNames{
    "local", "linear", "quadratic", "distance", "auto"};
[[nodiscard]] constexpr std::string_view prediction_name(Prediction prediction) noexcept
{
    TACTUS_ASSERT(prediction <= Prediction::automatic);
    return kPredictionNames[static_cast<std::size_t>(prediction)];
}

} // namespace tactus
