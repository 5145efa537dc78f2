// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_input.hpp"
#include "transport/served_model.hpp"

namespace tactus::hrtc
{

/// How many faces of the source a square metre of a model has on average, taken from the area of
/// its base mesh, at a scale of 1. 0 where the base mesh isn't here.
[[nodiscard]] double mean_faces_per_m2(const ServedModel& model);

/// About how many faces a frame looks at when the tool lies flat on a surface of that density:
/// those below its core and in reach around it. 0 for tools that are meshes. Any thread.
[[nodiscard]] double faces_under(const ToolSpec& tool, double faces_per_m2);

/// What a tool that lies on a model asks for, in faces, about.
struct Footprint
{
    double faces{0.0}; ///< A frame looks at.
    double kept{0.0};  ///< The pools need room for, beside the base mesh, where those are exact.
};

/// Both are 0 for tools that are meshes and for models whose base mesh isn't here. `scale` is the
/// object's. Reads the base mesh; any thread.
[[nodiscard]] Footprint footprint_of(const ToolSpec& tool, const ServedModel& model, double scale);

} // namespace tactus::hrtc
