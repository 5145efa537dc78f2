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
/// Density of a model, from its base mesh. Any thread; the functions below, too.
[[nodiscard]] FaceDensity face_density(const ServedModel& model);

/// Approximate number of faces that a frame searches if the tool lies flat on a surface of that
/// density. These are the faces below its core and within reach around it. 0 for mesh tools.
[[nodiscard]] double faces_under(const ToolSpec& tool, double faces_per_m2);

/// Approximate demand of a tool that lies on a model, in faces.
struct Footprint
{
    double faces{0.0}; ///< Faces that a frame searches.
    double kept{0.0};  ///< Faces in the pools beside the base mesh, if the searched ones are exact.
};

/// Demand of the tool; 0 for mesh tools and for a density of 0. `scale` is the object's.
[[nodiscard]] Footprint footprint_of(const ToolSpec& tool, const FaceDensity& density,
                                     double scale);

} // namespace tactus::hrtc
