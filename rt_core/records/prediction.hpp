// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tactus
{

/// How the place where a tool will touch is foretold: the paper's four ways, and the choice among
/// them.
enum class Prediction : std::uint8_t
{
    local_neighbours, ///< It stays; as far round it as the present speed leads may be touched.
    linear,           ///< Straight on at the present velocity.
    quadratic,        ///< At the present velocity and acceleration.
    distance_query,   ///< Straight on, but not through the surface that the last query found.
    automatic,        ///< Whichever of these erred least of late.
};
/// Those that foretell by themselves.
inline constexpr std::size_t kPredictions = 4;

/// As options and reports call them, in order.
inline constexpr std::array<std::string_view, kPredictions + 1> kPredictionNames{
    "local", "linear", "quadratic", "distance", "auto"};
[[nodiscard]] constexpr std::string_view prediction_name(Prediction prediction) noexcept
{
    return kPredictionNames[static_cast<std::size_t>(prediction)];
}

} // namespace tactus
