// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"

#include <array>
#include <string>
#include <vector>

namespace tactus::spm_build
{

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
