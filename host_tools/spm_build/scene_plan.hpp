// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/build/build_model.hpp"
#include "host_tools/scene/placed_models.hpp"
#include "host_tools/scene/scene.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/math/vec3.hpp"
#include "transport/base/refusal.hpp"

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::spm_build
{

/// Meshes that become models, and the objects that show them.
struct ScenePlan
{
    std::vector<MeshUse> meshes;            ///< Mesh of each model.
    std::vector<std::string> names;         ///< Name of each model.
    std::vector<Eigen::AlignedBox3d> boxes; ///< Box of each model's mesh.
    std::vector<std::size_t> faces;         ///< Number of faces of each model's mesh.
    std::vector<GridChoice> grids;          ///< Grid of each model.
    /// First model of each model's group; a group shares one grid.
    std::vector<std::size_t> groups;
    /// Vertices of each model that other models of its group may meet, relative to its
    /// GridChoice::place_m.
    std::vector<std::vector<Vec3>> borders_m;
    PlacedModels scene;
    std::vector<std::string> notes; ///< Notes on ignored content.
};

/// Reads every mesh; equal ones become one model. Objects whose meshes have no surface are ignored.
/// choose_grids() sets the grids.
[[nodiscard]] Result<ScenePlan, Refusal> plan_models(Scene& scene,
                                                     const std::filesystem::path& input);

/// Sets plan.grids: each model's grid contains the world's origin, seen from the model's first
/// object. Models that meet get the finest of their steps as the maximum step.
[[nodiscard]] std::optional<Refusal> choose_grids(Scene& scene, ScenePlan& plan,
                                                  const std::filesystem::path& input,
                                                  const ModelOptions& options);

/// Boxes, in the frame of the model's mesh and extended by a step, of the models that share its
/// grid and may meet it.
[[nodiscard]] std::vector<Eigen::AlignedBox3d> boxes_beside(const ScenePlan& plan,
                                                            std::size_t model);

/// Vertices, in the mesh's frame, of the other models of a model's group that may lie on its
/// borders.
[[nodiscard]] std::vector<std::array<double, 3>> vertices_beside(const ScenePlan& plan,
                                                                 std::size_t model);

/// Name of a model's mesh in messages.
[[nodiscard]] std::string source_of(const std::filesystem::path& input, const std::string& model);

} // namespace tactus::spm_build
