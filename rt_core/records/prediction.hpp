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

/// How the place where a tool will touch is predicted: the paper's four ways, and the choice among
/// them. Recordings store the number, so a new way goes in front of `automatic` only with a new
/// version of that format (platform/recording/setup_coding.cpp).
enum class Prediction : std::uint8_t
{
    local_neighbours, ///< It stays; as far round it as the present speed leads may be touched.
    linear,           ///< Straight on at the present velocity.
    quadratic,        ///< At the present velocity and acceleration.
    distance_query,   ///< Straight on, but not through the surface that the last query found.
    automatic,        ///< Whichever of these erred least recently.
};
/// Those that predict by themselves.
inline constexpr std::size_t kPredictions = 4;
static_assert(static_cast<std::size_t>(Prediction::automatic) == kPredictions);

/// As options and reports call them, in order.
inline constexpr std::array<std::string_view, kPredictions + 1> kPredictionNames{
    "local", "linear", "quadratic", "distance", "auto"};
[[nodiscard]] constexpr std::string_view prediction_name(Prediction prediction) noexcept
{
    TACTUS_ASSERT(prediction <= Prediction::automatic);
    return kPredictionNames[static_cast<std::size_t>(prediction)];
}

} // namespace tactus
