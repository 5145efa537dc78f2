// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/write_spm.hpp"
#include "host_tools/mesh/prepare.hpp"
#include "host_tools/mesh/triangle_mesh.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "tests/shared/brute_force.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::test
{

/// Source of a model, with its file.
struct MadeModel
{
    std::string name;
    std::filesystem::path path;
    PreparedMesh prepared;
    Simplification simplification;
    HeaderFields fields;
};

/// Simplifies and encodes a mesh into a file of the test's temporary folder. This and all functions
/// below end the test program with a line if a step refuses.
[[nodiscard]] MadeModel make_model(std::string name, const TriangleMesh& mesh,
                                   std::uint32_t base_faces,
                                   std::uint32_t position_bits = kMinPositionBits,
                                   double error_scale = 1.0);
/// The same for an already simplified mesh.
[[nodiscard]] MadeModel make_model(std::string name, PreparedMesh prepared,
                                   Simplification simplification, const EncodeOptions& options);

/// Model on disk, made by the encoder, with its source mesh as the truth.
struct TestModel
{
    std::string name;
    std::filesystem::path path;
    std::vector<Face> faces; ///< Faces of the quantised source, in the model frame.
    double diagonal_m{0.0};
    std::uint32_t base_faces{0};      ///< Requested faces of the base mesh, its maximum.
    std::array<double, 3> origin_m{}; ///< Origin of the model frame in the source's.
};

/// Faces of a mesh on its grid, in metres of the model frame; exact.
[[nodiscard]] std::vector<Face> faces_on_grid(const PreparedMesh& prepared);

/// The mesh, scaled about its origin.
[[nodiscard]] TriangleMesh scaled_mesh(TriangleMesh mesh, double factor);

/// Model that is made once for each name and process.
[[nodiscard]] const TestModel& test_model(const std::string& name, const TriangleMesh& mesh,
                                          std::uint32_t base_faces = 200);

/// The same with every certified bound multiplied by `error_scale` before coding: below 1 the
/// bounds are false, for tests of tests. With 0 all bounds are the least possible, 1/256 of a
/// quantum, so that a distance to a coarse face is taken for the true one.
[[nodiscard]] const TestModel& lying_model(const std::string& name, const TriangleMesh& mesh,
                                           double error_scale);

/// Models of smooth, sharp, open, thin and needle shapes, a few thousand faces each.
inline constexpr std::size_t kSmallModels = 7;
[[nodiscard]] const TestModel& small_model(std::size_t index);
[[nodiscard]] std::vector<const TestModel*> small_models();

/// Well-known mesh, from the folder TACTUS_MESHES.
struct KnownMesh
{
    const char* name;
    const char* file;
};

/// Meshes in order; the largest, of 269,000 faces, is last.
inline constexpr KnownMesh kKnownMeshes[] = {{"cow", "cow.obj"},
                                             {"teapot", "teapot.obj"},
                                             {"fandisk", "fandisk.obj"},
                                             {"bunny", "stanford-bunny.obj"},
                                             {"igea", "igea.ply"}};

/// Mesh from its file; empty without TACTUS_MESHES. A missing file ends the program with a line.
[[nodiscard]] std::optional<TriangleMesh> read_known(const KnownMesh& mesh);
/// Model of a mesh; null without TACTUS_MESHES.
[[nodiscard]] const TestModel* known_model(const KnownMesh& mesh);

} // namespace tactus::test
