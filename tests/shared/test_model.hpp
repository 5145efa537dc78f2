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

/// What a model was made of, and its file.
struct MadeModel
{
    std::string name;
    std::filesystem::path path;
    PreparedMesh prepared;
    Simplification simplification;
    HeaderFields fields;
};

/// Simplifies and encodes a mesh into a file of the test's temporary folder. As make_model() and
/// all below it ends the test program with a line when a step refuses.
[[nodiscard]] MadeModel make_model(std::string name, const TriangleMesh& mesh,
                                   std::uint32_t base_faces,
                                   std::uint32_t position_bits = kMinPositionBits,
                                   double error_scale = 1.0);
/// The same of a mesh that is simplified.
[[nodiscard]] MadeModel make_model(std::string name, PreparedMesh prepared,
                                   Simplification simplification, const EncodeOptions& options);

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

/// A model that is made once a name and process.
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

/// A mesh that others know, too; it has to be in the folder that TACTUS_MESHES names.
struct KnownMesh
{
    const char* name;
    const char* file;
};

/// The largest, of 269,000 faces, comes last.
inline constexpr KnownMesh kKnownMeshes[] = {{"cow", "cow.obj"},
                                             {"teapot", "teapot.obj"},
                                             {"fandisk", "fandisk.obj"},
                                             {"bunny", "stanford-bunny.obj"},
                                             {"igea", "igea.ply"}};

/// None without TACTUS_MESHES; a file that isn't there ends the program with a line.
[[nodiscard]] std::optional<TriangleMesh> read_known(const KnownMesh& mesh);
/// Null without TACTUS_MESHES.
[[nodiscard]] const TestModel* known_model(const KnownMesh& mesh);

} // namespace tactus::test
