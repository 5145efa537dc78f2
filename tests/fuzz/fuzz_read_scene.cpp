// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
/// The input is a scene file, .gltf or .glb by its first bytes. Every mesh of an accepted one is
/// read; one whose objects name their models is written again.
#include "host_tools/scene/placed_models.hpp"
#include "host_tools/scene/scene.hpp"
#include "rt_core/limits.hpp"
#include "tests/fuzz/law.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "transport/model_name.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <string>

namespace tactus::fuzz
{

namespace
{

void check_object(const SceneObject& object)
{
    require(is_valid_name(object.name), "an object's name is valid");
    require(is_one_clear_line(object.place), "a node is named in one clear line");
    require(object.mesh || object.model.ends_with(".spm"), "an object shows a mesh or a model");
    double length = 0.0;
    for (const double part : object.pose.rotation)
    {
        length += part * part;
    }
    require(checked_pose(object.pose).has_value() && std::abs(length - 1.0) < 1e-12,
            "an object's pose is one");
}

void check_mesh(const TriangleMesh& mesh)
{
    for (const auto& [x, y, z] : mesh.positions)
    {
        require(std::isfinite(x) && std::isfinite(y) && std::isfinite(z),
                "accepted coordinates are finite");
    }
    for (const auto& [a, b, c] : mesh.faces)
    {
        require(std::max({a, b, c}) < mesh.positions.size(), "accepted indices name vertices");
    }
}

void check_scene(Scene& scene, const std::string& path)
{
    std::set<std::string> names;
    for (const SceneObject& object : scene.objects())
    {
        check_object(object);
        names.insert(object.name);
        if (!object.is_touched || !object.mesh)
        {
            continue;
        }
        require(is_valid_name(scene.mesh_name(*object.mesh)), "a mesh's name is valid");
        const auto mesh = scene.read_mesh(*object.mesh);
        if (mesh)
        {
            require(!mesh.value().mesh.faces.empty() || !mesh.value().left_out.empty(),
                    "an accepted mesh has faces, or says why it has none");
            check_mesh(mesh.value().mesh);
        }
        else
        {
            require(is_clear_refusal(mesh.error().text, path), "a mesh is refused in one line");
        }
    }
    require(!names.empty() && names.size() <= kMaxObjects && names.size() == scene.objects().size(),
            "1 to 4096 objects have names of their own");
}

/// A written scene is read back unchanged.
void check_written(ScratchFile& scratch)
{
    const auto placed = read_placed_models(scratch.path());
    if (!placed)
    {
        require(is_clear_refusal(placed.error().text, scratch.path().string()),
                "a scene without models is refused in one line");
        return;
    }
    const std::string text = scene_text(placed.value());
    scratch.replace(std::as_bytes(std::span(text)));
    const auto again = read_placed_models(scratch.path());
    require(again.has_value() && again.value().files == placed.value().files &&
                again.value().objects.size() == placed.value().objects.size(),
            "a written scene is read again");
}

} // namespace

} // namespace tactus::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace tactus;
    static fuzz::ScratchFile scratch("scene.gltf");
    scratch.replace(std::as_bytes(std::span(data, size)));
    auto scene = Scene::open(scratch.path());
    if (!scene)
    {
        fuzz::require(fuzz::is_clear_refusal(scene.error().text, scratch.path().string()),
                      "a refusal is one clear line that begins with the file's name");
        return 0;
    }
    ++fuzz::accepted_inputs;
    fuzz::check_scene(scene.value(), scratch.path().string());
    fuzz::check_written(scratch);
    return 0;
}
