// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_input.hpp"
#include "transport/served_model.hpp"

namespace tactus::hrtc
{

/// How densely the faces of a model's source lie, at a scale of 1, on average.
struct FaceDensity
{
    double faces{0.0};  ///< In all,
    double per_m2{0.0}; ///< and by the area of its base mesh; 0 where that isn't here.
};
/// Reads the base mesh. Any thread, as are the others.
[[nodiscard]] FaceDensity face_density(const ServedModel& model);

/// About how many faces a frame looks at when the tool lies flat on a surface of that density:
/// those below its core and in reach around it. 0 for tools that are meshes.
[[nodiscard]] double faces_under(const ToolSpec& tool, double faces_per_m2);

/// What a tool that lies on a model asks for, in faces, about.
struct Footprint
{
    double faces{0.0}; ///< A frame looks at.
    double kept{0.0};  ///< The pools need room for, beside the base mesh, where those are exact.
};

/// Both are 0 for tools that are meshes and for a density of 0. `scale` is the object's.
[[nodiscard]] Footprint footprint_of(const ToolSpec& tool, const FaceDensity& density,
                                     double scale);

} // namespace tactus::hrtc
