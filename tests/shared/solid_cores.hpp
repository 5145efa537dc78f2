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

/// A tool's core and what it is made of, in its own frame: the faces that are to meet none of an
/// object. What it refers to outlives it.
struct SolidCore
{
    std::string name;
    ToolCore core;
    std::vector<Triangle> faces;
    double radius_m{0.0};
    const TestModel* mesh{nullptr}; ///< Of a core that is a mesh: model 1 of the frame.
};

[[nodiscard]] SolidCore box_core(const std::string& name, const Vec3& half, double radius_m);
[[nodiscard]] SolidCore segment_core(const std::string& name, const Segment& segment,
                                     double radius_m);
/// The hull of a tetrahedron, 3 cm long.
[[nodiscard]] SolidCore spike_core(double radius_m);
[[nodiscard]] SolidCore mesh_core(const std::string& name, const TestModel& mesh, double radius_m);

/// Faces of the placed core that meet the model's, by exact arithmetic; the model's frame.
[[nodiscard]] int crossings(const SolidCore& solid, const Similarity& place,
                            const TestModel& model);

/// The same on the way from one place to another, at so many places: `center` of the tool goes
/// straight while it turns round one axis.
[[nodiscard]] int crossings_on_way(const SolidCore& solid, const Similarity& from,
                                   const Similarity& to, const Vec3& center, const TestModel& model,
                                   int places);

} // namespace tactus::test
