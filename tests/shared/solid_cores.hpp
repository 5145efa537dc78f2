// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/geometry/tool_core.hpp"
#include "rt_core/math/similarity.hpp"
#include "rt_core/math/triangle.hpp"
#include "tests/shared/test_model.hpp"

#include <string>
#include <vector>

namespace tactus::test
{

/// Core of a tool with its faces in its own frame, which must not meet those of an object.
/// References in it outlive it.
struct SolidCore
{
    std::string name;
    ToolCore core;
    std::vector<Triangle> faces;
    double radius_m{0.0};
    const TestModel* mesh{nullptr}; ///< Mesh of a mesh core: model 1 of the frame.
};

[[nodiscard]] SolidCore box_core(const std::string& name, const Vec3& half, double radius_m);
[[nodiscard]] SolidCore segment_core(const std::string& name, const Segment& segment,
                                     double radius_m);
/// Hull of a tetrahedron, 3 cm long.
[[nodiscard]] SolidCore spike_core(double radius_m);
[[nodiscard]] SolidCore mesh_core(const std::string& name, const TestModel& mesh, double radius_m);

/// Number of faces of the placed core that meet the model's, by exact arithmetic, in the model
/// frame.
[[nodiscard]] int crossings(const SolidCore& solid, const Similarity& place,
                            const TestModel& model);

/// Number on the path from one place to another, at `places` places: `center` of the tool moves
/// straight while the tool rotates about one axis.
[[nodiscard]] int crossings_on_way(const SolidCore& solid, const Similarity& from,
                                   const Similarity& to, const Vec3& center, const TestModel& model,
                                   int places);

} // namespace tactus::test
