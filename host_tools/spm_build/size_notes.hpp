// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"

#include <array>
#include <string>
#include <vector>

namespace tactus::spm_build
{

/// Size and place of a model, as the file has them.
struct ModelPlace
{
    double diagonal_m{0.0};
    double metres_per_unit{1.0};          ///< Of the source.
    std::array<double, 3> low_corner_m{}; ///< Of its box.
};

/// Whether a mesh can be the ground of somewhere: an open sheet, much wider than high, all of whose
/// faces look to one side. Linear in the faces.
[[nodiscard]] bool is_like_terrain(const TriangleMesh& mesh);

/// A note when the model's size is hardly meant, with the units that would make it usual, and one
/// when it stands far from the origin. `has_own_size`: a unit or a diagonal was asked for.
[[nodiscard]] std::vector<std::string> size_notes(const TriangleMesh& mesh, const ModelPlace& place,
                                                  bool has_own_size);

} // namespace tactus::spm_build
