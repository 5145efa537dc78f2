// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/scene/placed_models.hpp"

#include "host_tools/scene/scene.hpp"
#include "transport/material_text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <map>

namespace tactus
{

namespace
{

nlohmann::ordered_json material_json(const Material& material)
{
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    for (const MaterialKey& key : kMaterialKeys)
    {
        // Dynamic friction is written whenever there is static friction: if missing, it is read as
        // equal to the static one.
        const bool is_said = key.value == &Material::dynamic_friction
                                 ? material.static_friction != 0.0
                                 : material.*key.value != Material{}.*key.value;
        if (is_said)
        {
            json[std::string(key.name)] = material.*key.value;
        }
    }
    return json;
}

nlohmann::ordered_json node_json(const PlacedModel& object, const std::string& file)
{
    nlohmann::ordered_json ours = {{"model", file}};
    if (const auto material = material_json(object.material); !material.empty())
    {
        ours["material"] = material;
    }
    const double s = object.pose.scale;
    return {{"name", object.name},
            {"translation", object.pose.translation_m},
            {"rotation", object.pose.rotation},
            {"scale", {s, s, s}},
            {"extras", {{"tactus", ours}}}};
}

} // namespace

Result<PlacedModels, Refusal> read_placed_models(const std::filesystem::path& path)
{
    const auto scene = Scene::open(path);
    if (!scene)
    {
        return scene.error();
    }
    PlacedModels placed;
    placed.notes = scene.value().notes();
    std::map<std::string, std::size_t> known;
    for (const SceneObject& object : scene.value().objects())
    {
        if (!object.is_touched)
        {
            continue;
        }
        if (object.model.empty())
        {
            return Refusal{fmt::format("{0}: {1} names no model in extras.tactus; build models "
                                       "from the scene's meshes with: spm_build {0} -o FOLDER",
                                       path.string(), object.place)};
        }
        const auto [model, is_new] = known.try_emplace(object.model, placed.files.size());
        if (is_new)
        {
            placed.files.push_back(path.parent_path() / object.model);
        }
        placed.objects.push_back({object.name, model->second, object.pose, object.material});
    }
    return placed;
}

std::string scene_text(const PlacedModels& scene)
{
    nlohmann::ordered_json nodes = nlohmann::ordered_json::array();
    nlohmann::ordered_json roots = nlohmann::ordered_json::array();
    for (const PlacedModel& object : scene.objects)
    {
        roots.push_back(nodes.size());
        nodes.push_back(node_json(object, scene.files.at(object.model).filename().string()));
    }
    const nlohmann::ordered_json text = {{"asset", {{"version", "2.0"}, {"generator", "Tactus"}}},
                                         {"scene", 0},
                                         {"scenes", {{{"nodes", roots}}}},
                                         {"nodes", nodes}};
    return text.dump(1) + '\n';
}

} // namespace tactus
