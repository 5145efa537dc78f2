// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_build/scene_plan.hpp"

#include "host_tools/mesh/index_lists.hpp"
#include "host_tools/mesh/mesh_places.hpp"
#include "host_tools/scene/scene_names.hpp"
#include "host_tools/scene/shared_grids.hpp"
#include "platform/program/progress.hpp"
#include "transport/content_hash.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <span>
#include <utility>

namespace tactus::spm_build
{

namespace
{

namespace fs = std::filesystem;

ContentHash hash_of(const TriangleMesh& mesh)
{
    const std::array<ContentHash, 2> parts{content_hash(std::as_bytes(std::span(mesh.positions))),
                                           content_hash(std::as_bytes(std::span(mesh.faces)))};
    return content_hash(std::as_bytes(std::span(parts)));
}

/// Result of reading a mesh: the index of its model, or the reason why it has none.
struct PlannedMesh
{
    std::optional<std::size_t> model;
    std::string left_out;
};

/// Maximum number of corners in SharedGrids: they take a quarter of the allowed memory, since a
/// growing list exists twice.
std::size_t corners_max(const ModelOptions& options)
{
    return options.memory_mib
               ? std::min(SharedGrids::kCornersMax,
                          (std::size_t{*options.memory_mib} << 20U) / 4 / SharedGrids::kCornerBytes)
               : SharedGrids::kCornersMax;
}

/// First model of each group, by model; see SharedGrids::first_of_each().
Result<std::vector<std::size_t>, Refusal> find_groups(Scene& scene, const ScenePlan& plan,
                                                      const ModelOptions& options)
{
    if (plan.meshes.size() < 2)
    {
        return std::vector<std::size_t>(plan.meshes.size(), 0);
    }
    SharedGrids shared(plan.meshes.size(), corners_max(options));
    const std::vector<PlacedModel>& objects = plan.scene.objects;
    const IndexLists objects_of(plan.meshes.size(),
                                [&objects](const auto& add)
                                {
                                    for (std::uint32_t i = 0; i < objects.size(); ++i)
                                    {
                                        add(static_cast<std::uint32_t>(objects[i].model), i);
                                    }
                                });
    for (std::uint32_t model = 0; model < plan.meshes.size(); ++model)
    {
        const auto mesh = scene.read_mesh(plan.meshes[model]);
        if (!mesh)
        {
            return mesh.error();
        }
        for (const std::uint32_t object : objects_of.of(model))
        {
            shared.add(model, objects[object].pose, mesh.value().mesh);
        }
    }
    return shared.first_of_each();
}

/// Sets the maximum step of models that meet to the finest of their steps.
std::optional<Refusal> share_steps(Scene& scene, ScenePlan& plan, const fs::path& input,
                                   const ModelOptions& options)
{
    std::vector<std::size_t> members(plan.groups.size(), 0);
    for (const std::size_t first : plan.groups)
    {
        ++members[first];
    }
    Progress progress("spm_build", "measure", "faces");
    const std::size_t all = std::accumulate(plan.faces.begin(), plan.faces.end(), std::size_t{0});
    std::size_t measured = 0;
    std::map<std::size_t, double> finest_m;
    for (std::size_t model = 0; model < plan.groups.size(); ++model)
    {
        measured += plan.faces[model];
        if (members[plan.groups[model]] == 1)
        {
            continue;
        }
        const auto mesh = scene.read_mesh(plan.meshes[model]);
        const auto step_m =
            mesh ? grid_step_of(mesh.value().mesh, source_of(input, plan.names[model]), options,
                                plan.grids[model])
                 : Result<double, Refusal>(mesh.error());
        if (!step_m)
        {
            return step_m.error();
        }
        double& finest = finest_m.try_emplace(plan.groups[model], step_m.value()).first->second;
        finest = std::min(finest, step_m.value());
        progress.update(measured, all);
    }
    for (std::size_t model = 0; model < plan.groups.size(); ++model)
    {
        if (const auto finest = finest_m.find(plan.groups[model]); finest != finest_m.end())
        {
            plan.grids[model].quantum_max_m = finest->second;
        }
    }
    return std::nullopt;
}

/// Stores the vertices of models that others may meet, for vertices_beside().
std::optional<Refusal> find_borders(Scene& scene, ScenePlan& plan)
{
    plan.borders_m.resize(plan.meshes.size());
    for (std::size_t model = 0; model < plan.meshes.size(); ++model)
    {
        const std::vector<Eigen::AlignedBox3d> boxes = plan.grids[model].quantum_max_m
                                                           ? boxes_beside(plan, model)
                                                           : std::vector<Eigen::AlignedBox3d>{};
        if (boxes.empty())
        {
            continue;
        }
        const auto mesh = scene.read_mesh(plan.meshes[model]);
        if (!mesh)
        {
            return mesh.error();
        }
        for (const auto& position : mesh.value().mesh.positions)
        {
            const Vec3 at_m(position.data());
            if (std::ranges::any_of(boxes, [&](const auto& box) { return box.contains(at_m); }))
            {
                plan.borders_m[model].push_back(at_m - Vec3(plan.grids[model].place_m.data()));
            }
        }
    }
    return std::nullopt;
}

} // namespace

Result<ScenePlan, Refusal> plan_models(Scene& scene, const fs::path& input)
{
    ScenePlan plan;
    plan.notes = scene.notes();
    LeftOut left_out;
    std::map<MeshUse, PlannedMesh> by_use;
    std::map<ContentHash, std::size_t> by_content;
    for (const SceneObject& object : scene.objects())
    {
        if (!object.is_touched)
        {
            continue;
        }
        if (!object.mesh)
        {
            return Refusal{fmt::format("{}: {} names a model already; only meshes are encoded",
                                       input.string(), object.place)};
        }
        const auto [use, is_first] = by_use.try_emplace(*object.mesh);
        PlannedMesh& planned = use->second;
        if (is_first)
        {
            const auto mesh = scene.read_mesh(*object.mesh);
            if (!mesh)
            {
                return mesh.error();
            }
            planned.left_out = mesh.value().left_out;
            if (!mesh.value().mesh.faces.empty())
            {
                planned.model =
                    by_content.try_emplace(hash_of(mesh.value().mesh), plan.meshes.size())
                        .first->second;
            }
            if (planned.model == plan.meshes.size())
            {
                plan.meshes.push_back(*object.mesh);
                plan.boxes.push_back(box_of(mesh.value().mesh));
                plan.faces.push_back(mesh.value().mesh.faces.size());
                plan.names.push_back(plain_name(scene.mesh_name(*object.mesh) +
                                                (object.mesh->is_mirrored ? "-mirrored" : "")));
            }
            if (planned.model && !planned.left_out.empty())
            {
                left_out.add(planned.left_out + "; they have no surface",
                             "parts of " + scene.mesh_place(*object.mesh));
            }
        }
        if (planned.model)
        {
            plan.scene.objects.push_back(
                {object.name, *planned.model, object.pose, object.material});
        }
        else
        {
            left_out.add("no surface: " + planned.left_out, object.place);
        }
    }
    std::ranges::copy(left_out.notes(), std::back_inserter(plan.notes));
    if (plan.scene.objects.empty())
    {
        return Refusal{
            fmt::format("{}: no object is left to touch: {}", input.string(), plan.notes.back())};
    }
    plan.names = unique_names(plan.names);
    for (const std::string& name : plan.names)
    {
        plan.scene.files.emplace_back(name + ".spm");
    }
    return plan;
}

std::string source_of(const fs::path& input, const std::string& model)
{
    return fmt::format("{}: mesh of {}", input.string(), model);
}

std::optional<Refusal> choose_grids(Scene& scene, ScenePlan& plan, const fs::path& input,
                                    const ModelOptions& options)
{
    plan.grids.resize(plan.meshes.size());
    std::vector<bool> is_placed(plan.meshes.size(), false);
    for (const PlacedModel& object : plan.scene.objects)
    {
        if (!is_placed[object.model])
        {
            plan.grids[object.model].place_m = world_origin_in(object.pose);
            is_placed[object.model] = true;
        }
    }
    auto groups = find_groups(scene, plan, options);
    if (!groups)
    {
        return groups.error();
    }
    plan.groups = std::move(groups).value();
    if (auto refused = share_steps(scene, plan, input, options))
    {
        return refused;
    }
    return find_borders(scene, plan);
}

std::vector<Eigen::AlignedBox3d> boxes_beside(const ScenePlan& plan, std::size_t model)
{
    const auto grown = [&](std::size_t number)
    {
        const double step_m = *plan.grids[number].quantum_max_m;
        Eigen::AlignedBox3d box = plan.boxes[number];
        box.translate(Vec3(plan.grids[model].place_m.data()) -
                      Vec3(plan.grids[number].place_m.data()));
        return Eigen::AlignedBox3d(box.min().array() - step_m, box.max().array() + step_m);
    };
    std::vector<Eigen::AlignedBox3d> boxes;
    for (std::size_t other = 0; other < plan.meshes.size(); ++other)
    {
        if (other != model && plan.groups[other] == plan.groups[model] &&
            grown(other).intersects(grown(model)))
        {
            boxes.push_back(grown(other));
        }
    }
    return boxes;
}

std::vector<std::array<double, 3>> vertices_beside(const ScenePlan& plan, std::size_t model)
{
    const Vec3 place_m(plan.grids[model].place_m.data());
    const Vec3 step_m = Vec3::Constant(*plan.grids[model].quantum_max_m);
    const Eigen::AlignedBox3d box(plan.boxes[model].min() - step_m,
                                  plan.boxes[model].max() + step_m);
    std::vector<std::array<double, 3>> vertices;
    for (std::size_t other = 0; other < plan.meshes.size(); ++other)
    {
        if (other == model || plan.groups[other] != plan.groups[model])
        {
            continue;
        }
        for (const Vec3& border_m : plan.borders_m[other])
        {
            const Vec3 at_m = place_m + border_m;
            if (box.contains(at_m))
            {
                vertices.push_back({at_m.x(), at_m.y(), at_m.z()});
            }
        }
    }
    return vertices;
}

} // namespace tactus::spm_build
