// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/model_id.hpp"
#include "rt_core/geometry/convex.hpp"
#include "rt_core/geometry/shapes.hpp"
#include "rt_core/math/similarity.hpp"

#include <variant>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// The origin of the tool's frame.
struct PointCore
{
};

/// A tool that is a mesh: all faces of a model of its own, in the frame of the mesh file that the
/// model was made of. Only `model` is to be given; the frame knows the rest from its header.
struct MeshCore
{
    ModelId model{};
    Vec3 origin_m{0.0, 0.0, 0.0}; ///< Of the model's frame in the tool's; the axes are parallel.
    Vec3 extent_m{0.0, 0.0, 0.0}; ///< The model lies between its origin and this.
};

/// What is left of a tool when its radius is taken off: a tool is everything within its radius of
/// its core. A sphere is a point with a radius, a capsule a segment with one, a box may have
/// rounded edges. In the tool's own frame, metres; finite, which nothing checks. What a hull or
/// body refers to outlives the tool.
using ToolCore = std::variant<PointCore, Segment, Box, Hull, ConvexBody, MeshCore>;

} // namespace tactus
