// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"
#include "host_tools/scene/placed_models.hpp"
#include "transport/base/refusal.hpp"

#include <Eigen/Geometry>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::spm_build
{

/// Rotation, scale and translation of the input, in this order.
struct Placing
{
    bool is_y_up{false}; ///< True if its y axis points up; z does then, as for devices.
    double scale{1.0};
    bool is_centered{false}; ///< True if the middle of its box becomes the origin.
};

/// Rotates a mesh so that its y axis becomes z.
void turn_y_up(TriangleMesh& mesh);

/// Places the objects of a scene, whose models have these boxes; the middle is that of the objects'
/// boxes. Adds a note about a translation. Refuses an object whose pose or scale would be out of
/// range.
[[nodiscard]] std::optional<Refusal> place_objects(const Placing& placing,
                                                   std::span<const Eigen::AlignedBox3d> boxes,
                                                   std::vector<PlacedModel>& objects,
                                                   std::vector<std::string>& notes);

} // namespace tactus::spm_build
