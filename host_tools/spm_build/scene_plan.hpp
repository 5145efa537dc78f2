// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/scene/placed_models.hpp"
#include "host_tools/scene/scene.hpp"
#include "host_tools/spm_build/build_model.hpp"
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

/// Which meshes become models, and who shows them.
struct ScenePlan
{
    std::vector<MeshUse> meshes;            ///< One a model.
    std::vector<std::string> names;         ///< Likewise.
    std::vector<Eigen::AlignedBox3d> boxes; ///< Likewise.
    std::vector<std::size_t> faces;         ///< Likewise; of their meshes.
    std::vector<GridChoice> grids;          ///< Likewise.
    std::vector<std::size_t> groups;        ///< Likewise: the first model that shares its grid.
    /// Likewise: the vertices that others of the group may meet, from the grid's place.
    std::vector<std::vector<Vec3>> borders_m;
    PlacedModels scene;
    std::vector<std::string> notes; ///< What is left out.
};

/// Reads every mesh; equal ones become one model. Objects whose meshes have no surface are left
/// out. The grids come with choose_grids().
[[nodiscard]] Result<ScenePlan, Refusal> plan_models(Scene& scene,
                                                     const std::filesystem::path& input);

/// Lays each model's grid through the world's origin, as its first object sees it, and gives models
/// that meet the finest of their steps.
[[nodiscard]] std::optional<Refusal> choose_grids(Scene& scene, ScenePlan& plan,
                                                  const std::filesystem::path& input,
                                                  const ModelOptions& options);

/// The boxes of the models that share a model's grid and may meet it, in the mesh's frame.
[[nodiscard]] std::vector<Eigen::AlignedBox3d> boxes_beside(const ScenePlan& plan,
                                                            std::size_t model);

/// Vertices of the other models of a model's group that may lie on its borders, in the mesh's
/// frame.
[[nodiscard]] std::vector<std::array<double, 3>> vertices_beside(const ScenePlan& plan,
                                                                 std::size_t model);

/// A model's mesh, for messages.
[[nodiscard]] std::string source_of(const std::filesystem::path& input, const std::string& model);

} // namespace tactus::spm_build
