// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/frame_rig.hpp"

#include <string_view>
#include <vector>

namespace tactus::test
{

/// What a frame has too little of.
struct Hardship
{
    const char* name;
    Budgets budgets{};
    RigOptions rig{};
    double radius_diag{0.01}; ///< Of the tool; 0 is a point.
    bool has_all{false};      ///< Nothing is scarce: nearly every frame has an answer.
};

/// Budgets from K = 1 up, pools too small, chunks lost, damaged, delayed and evicted, tools from a
/// point to one larger than the model; each by itself. The pools have room for the base mesh.
[[nodiscard]] std::vector<Hardship> hardships(const TestModel& model);
/// One of them; a name that there isn't ends the program.
[[nodiscard]] Hardship hardship_named(const TestModel& model, std::string_view name);

/// The options of a rig for one sphere of this radius; force and speed as usual.
[[nodiscard]] RigOptions with_tool(RigOptions options, double radius_m);

} // namespace tactus::test
