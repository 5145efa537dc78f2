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

/// A tool that is a mesh: all faces of its own model, in the frame of the mesh file that the model
/// was built from. Only `model` is set by the caller; the frame takes the rest from the model's
/// header.
struct MeshCore
{
    ModelId model{};
    /// Origin of the model's frame in the tool's; the axes are parallel.
    Vec3 origin_m{0.0, 0.0, 0.0};
    /// Size of the model, which lies between its origin and this.
    Vec3 extent_m{0.0, 0.0, 0.0};
};

/// Core of a tool, which consists of all points within its radius of the core: a sphere is a point
/// with a radius, a capsule a segment with one, a box may have rounded edges. The tool's own frame,
/// metres; finite, which is not checked. Data that a hull or convex body refers to outlives the
/// tool.
using ToolCore = std::variant<PointCore, Segment, Box, Hull, ConvexBody, MeshCore>;

} // namespace tactus
