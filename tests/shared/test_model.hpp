// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/prepare.hpp"
#include "host_tools/mesh/triangle_mesh.hpp"
#include "tests/shared/brute_force.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tactus::test
{

/// A model on disk, made by the encoder, and its source mesh as the truth to compare with.
struct TestModel
{
    std::string name;
    std::filesystem::path path;
    std::vector<Face> faces; ///< Of the quantised source, in the model's frame.
    double diagonal_m{0.0};
    std::uint32_t base_faces{0};      ///< Asked for; the base mesh has these at most.
    std::array<double, 3> origin_m{}; ///< Of the model's frame in the source's.
};

/// The faces of a mesh on its grid, in metres of the model's frame; exact.
[[nodiscard]] std::vector<Face> faces_on_grid(const PreparedMesh& prepared);

/// Prepares, simplifies and encodes a mesh into a file of the test's temporary folder; made once a
/// name and process. Ends the test program with a line when a step refuses.
[[nodiscard]] const TestModel& test_model(const std::string& name, const TriangleMesh& mesh,
                                          std::uint32_t base_faces = 200);

/// The same with every certified bound multiplied by `error_scale` before it is coded: below 1 a
/// model that lies, for tests of tests. With 0 all bounds are the least that there is, 1/256 of a
/// quantum, so that a distance to a coarse face is taken for the true one.
[[nodiscard]] const TestModel& lying_model(const std::string& name, const TriangleMesh& mesh,
                                           double error_scale);

/// Models that cover smooth, sharp, open, thin and needle shapes; a few thousand faces each.
inline constexpr std::size_t kSmallModels = 7;
[[nodiscard]] const TestModel& small_model(std::size_t index);
[[nodiscard]] std::vector<const TestModel*> small_models();

} // namespace tactus::test
