// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/touch_motion.hpp"

#include <cstdint>
#include <vector>

namespace tactus::bench
{

/// Parameters of a tour around a model with taps and slides.
struct TourManner
{
    double speed_diag_per_s{0.5};
    std::uint32_t taps{40};
    double tremor_m{0.0}; ///< Uniform noise on each axis of each sample, up to this.
};

/// Tour and the frames in which its taps meet the surface.
struct TapTour
{
    std::vector<Vec3> goals_m;
    std::vector<std::size_t> touches; ///< First frame of each tap within the tool's radius.
};

/// Taps all over the model, each after a flight of a quarter of a second at 3 % of the diagonal
/// above the surface, and followed by a slide of half a second. Everything, the descent included,
/// is at the manner's speed on average. Headings change by up to 3 rad/s. Computed from the mesh
/// alone, for a tool of kRadius_diag.
[[nodiscard]] TapTour tap_tour(const TouchScene& scene, const TourManner& manner);

} // namespace tactus::bench
