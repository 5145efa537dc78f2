// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/collapse_mesh.hpp"
#include "host_tools/simplify/simplify.hpp"

#include <cstdint>

namespace tactus
{

/// Degree to which a collapse spoils the faces that it changes. A round takes the least spoiling
/// collapses and uses the next level only if it would starve: a strict guard once left a needle
/// sphere stuck at 141,584 of 152,000 faces.
enum class Spoils : std::uint8_t
{
    nothing,
    thinness, ///< A face becomes thin, and more than twice as thin as it was.
    fold,     ///< A face rotates by more than 78 degrees, but does not flip.
    face,     ///< A face flips over or loses its area.
};

inline constexpr std::uint32_t kSpoilLevels = 4;

/// The worst effect on a fan face. A face without area cannot be spoilt.
[[nodiscard]] Spoils spoils(const QuantisedMesh& mesh, const Star& star) noexcept;

} // namespace tactus
