// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/model_id.hpp"
#include "rt_core/geometry/convex.hpp"
#include "rt_core/geometry/shapes.hpp"
#include "rt_core/math/similarity.hpp"

#include <variant>

// Usable on any thread: plain values and pure functions. No call waits or allocates.
namespace tactus
{

/// Point core, at the origin of the tool's frame.
struct PointCore
{
};

/// Mesh core: all faces of the tool's own model, in the frame of the mesh file that the model was
/// built from. The caller only sets `model`; the frame takes the rest from the model's header.
struct MeshCore
{
    ModelId model{};
    /// Origin of the model's frame in the tool's frame; the axes are parallel.
    Vec3 origin_m{0.0, 0.0, 0.0};
    /// Extent of the model: in its own frame it lies between the origin and this point.
    Vec3 extent_m{0.0, 0.0, 0.0};
};

/// Core of a tool, which consists of all points within its radius of the core. So a sphere is a
/// point with a radius, a capsule a segment, and a box may have rounded edges. The frame is the
/// tool's, the unit metres. Values must be finite, which is not checked. Data that a hull or convex
/// body refers to must outlive the tool.
using ToolCore = std::variant<PointCore, Segment, Box, Hull, ConvexBody, MeshCore>;

} // namespace tactus
