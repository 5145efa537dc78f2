// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"
#include "host_tools/scene/placed_models.hpp"
#include "transport/base/refusal.hpp"

#include <Eigen/Geometry>

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::spm_build
{

/// Rotation, scale and translation of the input, in this order.
struct Placing
{
    /// True if the input's y axis points up; it becomes z, the up axis of devices.
    bool is_y_up{false};
    double scale{1.0};
    bool is_centered{false}; ///< True if the middle of its box becomes the origin.
};

/// Rotates a mesh so that its y axis becomes z.
void turn_y_up(TriangleMesh& mesh);

/// Applies `placing` to the objects of a scene. `boxes` are those of the models, by
/// PlacedModel::model. Centring moves the middle of all objects' boxes to the origin and adds a
/// note. Refuses an object whose pose or scale would be out of range.
[[nodiscard]] std::optional<Refusal> place_objects(const Placing& placing,
                                                   std::span<const Eigen::AlignedBox3d> boxes,
                                                   std::vector<PlacedModel>& objects,
                                                   std::vector<std::string>& notes);

/// Size and place of a model in its file.
struct ModelPlace
{
    double diagonal_m{0.0};
    double metres_per_unit{1.0};          ///< Metres per unit of the source.
    std::array<double, 3> low_corner_m{}; ///< Least corner of its box.
};

/// True if a mesh may be terrain: an open sheet, much wider than high, whose faces all point to one
/// side. Linear in the faces.
[[nodiscard]] bool is_like_terrain(const TriangleMesh& mesh);

/// Notes about an unusual model size, with the units that would make it usual, and about a model
/// far from the origin. `has_own_size`: the user gave a unit or a diagonal, so the size is not
/// questioned.
[[nodiscard]] std::vector<std::string> size_notes(const TriangleMesh& mesh, const ModelPlace& place,
                                                  bool has_own_size);

} // namespace tactus::spm_build
