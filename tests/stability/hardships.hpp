// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/frame_rig.hpp"

#include <string_view>
#include <vector>

namespace tactus::test
{

/// Scarce resource of a frame.
struct Hardship
{
    const char* name;
    Budgets budgets{};
    RigOptions rig{};
    double radius_diag{0.01}; ///< Radius of the tool; 0 is a point.
    bool has_all{false};      ///< True if nothing is scarce: nearly every frame has an answer.
};

/// Budgets from K = 1, small pools, chunks lost, damaged, delayed and evicted, tools from a point
/// to one larger than the model; one hardship at a time. The pools hold the base mesh.
[[nodiscard]] std::vector<Hardship> hardships(const TestModel& model);
/// Hardship of that name; an unknown name ends the program.
[[nodiscard]] Hardship hardship_named(const TestModel& model, std::string_view name);

/// Options of a rig for one sphere of this radius, with the usual force and speed.
[[nodiscard]] RigOptions with_tool(RigOptions options, double radius_m);

} // namespace tactus::test
