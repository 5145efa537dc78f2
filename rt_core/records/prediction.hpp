// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

// Usable on any thread: plain values and pure functions. No call waits or allocates.
namespace tactus
{

/// Methods that predict where a tool will touch: the four of the 3DIM 2005 paper, and the
/// choice among them. Recordings store the number, so adding one before `automatic` needs a new
/// version of that format (platform/recording/setup_coding.cpp).
enum class Prediction : std::uint8_t
{
    local_neighbours, ///< The tool stays in place; its speed sets the radius that it may touch.
    linear,           ///< The tool moves straight on at its present velocity.
    quadratic,        ///< The tool keeps its present velocity and acceleration.
    distance_query, ///< The tool moves straight on, but not through the surface of the last query.
    automatic,      ///< The method above with the least recent error.
};
/// Number of methods, without `automatic`.
inline constexpr std::size_t kPredictions = 4;
static_assert(static_cast<std::size_t>(Prediction::automatic) == kPredictions);

/// Names in options and reports, in the order of Prediction.
inline constexpr std::array<std::string_view, kPredictions + 1> kPredictionNames{
    "local", "linear", "quadratic", "distance", "auto"};
[[nodiscard]] constexpr std::string_view prediction_name(Prediction prediction) noexcept
{
    TACTUS_ASSERT(prediction <= Prediction::automatic);
    return kPredictionNames[static_cast<std::size_t>(prediction)];
}

} // namespace tactus
