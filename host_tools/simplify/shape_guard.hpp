// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/collapse_mesh.hpp"
#include "host_tools/simplify/simplify.hpp"

#include <cstdint>

namespace tactus
{

/// How much a collapse spoils the faces it changes, from nothing to badly. A round takes the least
/// spoiling collapses there are and goes on to the next level only where it would starve: a strict
/// guard once left a needle sphere stuck at 141,584 of 152,000 faces.
enum class Spoils : std::uint8_t
{
    nothing,
    thinness, ///< A face gets thin, and more than twice as thin as it was.
    fold,     ///< A face turns by more than 78 degrees, but not over.
    face,     ///< A face turns over or loses its area.
};

inline constexpr std::uint32_t kSpoilLevels = 4;

/// The worst that happens to a fan face. A face without area can't be spoilt.
[[nodiscard]] Spoils spoils(const QuantisedMesh& mesh, const Star& star) noexcept;

} // namespace tactus
