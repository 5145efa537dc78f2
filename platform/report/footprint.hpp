// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_input.hpp"
#include "transport/served_model.hpp"

namespace tactus::hrtc
{

/// Mean density of the faces of a model's source, at a scale of 1.
struct FaceDensity
{
    double faces{0.0};  ///< Number of all faces.
    double per_m2{0.0}; ///< Faces by the area of the base mesh; 0 if that isn't resident.
};
/// Density of the faces of a model, from its base mesh. This and the functions below: any thread.
[[nodiscard]] FaceDensity face_density(const ServedModel& model);

/// Approximate number of faces that a frame searches if the tool lies flat on a surface of that
/// density: those below its core and within reach around it. 0 for mesh tools.
[[nodiscard]] double faces_under(const ToolSpec& tool, double faces_per_m2);

/// Approximate number of faces for a tool that lies on a model.
struct Footprint
{
    double faces{0.0}; ///< Faces that a frame searches.
    /// Faces in the pools beside the base mesh, so that the searched ones are exact.
    double kept{0.0};
};

/// Footprint of the tool on an object of this scale; 0 for mesh tools and a density of 0.
[[nodiscard]] Footprint footprint_of(const ToolSpec& tool, const FaceDensity& density,
                                     double scale);

} // namespace tactus::hrtc
