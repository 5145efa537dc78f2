// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/scene/detail/gltf_file.hpp"
#include "transport/base/printable.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <map>

namespace tactus::detail
{

namespace
{

using Use = ExtensionUse;

constexpr std::string_view kLater =
    "moves or hides nodes later; objects keep the first state in the file";
constexpr std::string_view kSplats = "adds clouds of points, which have no surface";
constexpr std::string_view kShapes = "adds shapes that are not meshes";
constexpr std::string_view kFiner =
    "adds finer meshes from other files; the meshes of this file are touched";
constexpr std::string_view kPlaces =
    "places the whole scene in the world; the nodes keep their relative poses";
constexpr std::string_view kStreams = "adds streamed meshes";
constexpr std::string_view kBodies = "adds rigid bodies that move nodes; the nodes' own meshes are "
                                     "touched, at their first poses in the file";

constexpr auto kKnown = std::to_array<KnownExtension>({
    // Extensions that are read.
    {"KHR_accessor_float64", Use::read, ""},
    {"KHR_draco_mesh_compression", Use::read, ""},
    {"KHR_mesh_quantization", Use::read, ""},
    {"KHR_meshopt_compression", Use::read, ""},
    {"KHR_node_visibility", Use::read, ""},
    {"EXT_mesh_gpu_instancing", Use::read, ""},
    {"EXT_meshopt_compression", Use::read, ""},
    {"MSFT_lod", Use::read, ""},
    // Extensions that add or move something.
    {"KHR_animation_pointer", Use::named, kLater},
    {"KHR_animation2", Use::named, kLater},
    {"KHR_behavior", Use::named, kLater},
    {"KHR_billboard", Use::named, kLater},
    {"KHR_character", Use::named, kLater},
    {"KHR_character_", Use::named, kLater},
    {"KHR_avatar", Use::named, kLater},
    {"KHR_avatar_", Use::named, kLater},
    {"KHR_interactivity", Use::named, kLater},
    {"KHR_anchor", Use::named, kPlaces},
    {"KHR_anchor_", Use::named, kPlaces},
    {"KHR_collision_shapes", Use::named, kBodies},
    {"KHR_implicit_shapes", Use::named, kShapes},
    {"KHR_physics_rigid_bodies", Use::named, kBodies},
    {"KHR_gaussian_splatting", Use::named, kSplats},
    {"KHR_gaussian_splatting_", Use::named, kSplats},
    {"KHR_materials_displacement", Use::named,
     "moves the surface by a picture; the surface is touched without this"},
    {"EXT_geopose", Use::named, kPlaces},
    {"EXT_implicit_", Use::named, kShapes},
    {"EXT_mesh_lod", Use::named, kFiner},
    {"EXT_primitive_voxels", Use::named, kShapes},
    {"EXT_property_animation", Use::named, kLater},
    {"AGI_articulations", Use::vital,
     "moves nodes to the start of its stages; nodes keep their poses without it"},
    {"CESIUM_RTC", Use::named, kPlaces},
    {"CESIUM_geopose", Use::named, kPlaces},
    {"FB_asset_variants", Use::named, kFiner},
    {"FRAUNHOFER_external_model", Use::vital, "adds objects from other files"},
    {"KITTYCAD_boundary_representation", Use::named, kShapes},
    {"MANYFOLD_mesh_progressive", Use::named, kFiner},
    {"MAXAR_collision_geometry", Use::named, kBodies},
    {"MAXAR_mesh_variants", Use::named,
     "adds variants of meshes; the file's first ones are touched"},
    {"MPEG_accessor_timed", Use::vital, kStreams},
    {"MPEG_anchor", Use::named, kPlaces},
    {"MPEG_animation_timing", Use::named, kLater},
    {"MPEG_buffer_circular", Use::vital, kStreams},
    {"MPEG_gaussian_splatting_transport", Use::named, kSplats},
    {"MPEG_mesh_linking", Use::named, kLater},
    {"MPEG_scene_dynamic", Use::named, kLater},
    {"NEEDLE_components", Use::named, kLater},
    {"NEEDLE_progressive", Use::named, kFiner},
    {"OMI_collider", Use::named, kBodies},
    {"OMI_physics_", Use::named, kBodies},
    {"VRMC_node_constraint", Use::named, kLater},
    {"VRMC_springBone", Use::named, kLater},
    {"VRM", Use::named, kLater},
    {"VRMC_vrm", Use::named, kLater},
    // Extensions for sight and sound, and data about the content.
    {"KHR_audio", Use::none, ""},
    {"KHR_audio_", Use::none, ""},
    {"KHR_blend", Use::none, ""},
    {"KHR_displayencoding", Use::none, ""},
    {"KHR_image_", Use::none, ""},
    {"KHR_lights", Use::none, ""},
    {"KHR_lights_", Use::none, ""},
    {"KHR_materials_", Use::none, ""},
    {"KHR_node_hoverability", Use::none, ""},
    {"KHR_node_selectability", Use::none, ""},
    {"KHR_technique_webgl", Use::none, ""},
    {"KHR_techniques_webgl", Use::none, ""},
    {"KHR_texture_", Use::none, ""},
    {"KHR_xmp", Use::none, ""},
    {"KHR_xmp_json_ld", Use::none, ""},
    {"EXT_feature_metadata", Use::none, ""},
    {"EXT_instance_features", Use::none, ""},
    {"EXT_lights_", Use::none, ""},
    {"EXT_materials_", Use::none, ""},
    {"EXT_mesh_features", Use::none, ""},
    {"EXT_mesh_manifold", Use::none, ""},
    {"EXT_mesh_opacity_micromap", Use::none, ""},
    {"EXT_mesh_polygon", Use::none, ""},
    {"EXT_mesh_primitive_edge_visibility", Use::none, ""},
    {"EXT_mesh_primitive_restart", Use::none, ""},
    {"EXT_structural_metadata", Use::none, ""},
    {"EXT_texture_", Use::none, ""},
    {"ADOBE_materials_", Use::none, ""},
    {"AGI_stk_metadata", Use::none, ""},
    {"BENTLEY_materials_", Use::none, ""},
    {"CESIUM_primitive_outline", Use::none, ""},
    {"FB_geometry_metadata", Use::none, ""},
    {"FB_ngon_encoding", Use::none, ""},
    {"GODOT_single_root", Use::none, ""},
    {"GRIFFEL_bim_data", Use::none, ""},
    {"MOZ_lightmap", Use::none, ""},
    {"MPEG_audio_spatial", Use::none, ""},
    {"MPEG_haptic", Use::none, ""},
    {"MPEG_media", Use::none, ""},
    {"MPEG_texture_video", Use::none, ""},
    {"MPEG_viewport_recommended", Use::none, ""},
    {"MSFT_packing_", Use::none, ""},
    {"MSFT_texture_dds", Use::none, ""},
    {"NV_materials_mdl", Use::none, ""},
});

/// Number of places that use an extension, and the name of the first.
struct Places
{
    std::size_t count{0};
    std::string first;
};

class PlacesOfExtensions
{
public:
    explicit PlacesOfExtensions(const nlohmann::json& root)
    {
        for (const char* list : {"extensionsUsed", "extensionsRequired"})
        {
            for (const nlohmann::json& name : array_of(root, list))
            {
                if (name.is_string())
                {
                    found_.try_emplace(name.get<std::string>());
                }
            }
        }
        take(root, "the file");
        for (const char* list :
             {"scenes", "nodes", "skins", "meshes", "accessors", "bufferViews", "buffers"})
        {
            std::size_t number = 0;
            for (const nlohmann::json& thing : array_of(root, list))
            {
                take(thing, list, number);
                for (const nlohmann::json& primitive : array_of(thing, "primitives"))
                {
                    take(primitive, list, number);
                }
                ++number;
            }
        }
    }

    [[nodiscard]] const std::map<std::string, Places>& found() const noexcept { return found_; }

private:
    /// Member `key` of `thing` if it is an array, otherwise an empty array. Wrong types are refused
    /// where the content is read.
    static const nlohmann::json& array_of(const nlohmann::json& thing, const char* key)
    {
        static const nlohmann::json kNone = nlohmann::json::array();
        const auto member = thing.is_object() ? thing.find(key) : thing.end();
        return member != thing.end() && member->is_array() ? *member : kNone;
    }

    template <typename... Place>
    void take(const nlohmann::json& thing, const Place&... place)
    {
        const auto member = thing.is_object() ? thing.find("extensions") : thing.end();
        if (member == thing.end() || !member->is_object())
        {
            return;
        }
        for (const auto& extension : member->items())
        {
            Places& places = found_[extension.key()];
            if (++places.count == 1)
            {
                places.first = text_of(place...);
            }
        }
    }

    static std::string text_of(const char* whole) { return whole; }
    static std::string text_of(const char* list, std::size_t number)
    {
        return fmt::format("{}[{}]", list, number);
    }

    std::map<std::string, Places> found_;
};

} // namespace

std::span<const KnownExtension> known_extensions() noexcept
{
    return kKnown;
}

KnownExtension known_extension(std::string_view name)
{
    const auto known = std::ranges::find_if(
        kKnown, [&](const KnownExtension& each)
        { return each.name.ends_with('_') ? name.starts_with(each.name) : name == each.name; });
    return known != kKnown.end()
               ? *known
               : KnownExtension{name, Use::vital,
                                "is unknown; its additions, motions and hidden nodes are not read"};
}

std::vector<std::string> required_extensions(const JsonAt& root)
{
    std::vector<std::string> required;
    const std::size_t count = root.size_of("extensionsRequired");
    for (std::size_t i = 0; i < count; ++i)
    {
        const JsonAt entry = root.at("extensionsRequired").at(i);
        const std::string& name = entry.text();
        const KnownExtension known = known_extension(name);
        if (known.use == Use::vital)
        {
            entry.refuse(fmt::format("is '{}', which is not supported: it {}; export without it, "
                                     "or remove it from this list if the surface doesn't need it",
                                     printable(name), known.left_out));
        }
        required.push_back(name);
    }
    return required;
}

std::vector<std::string> extension_notes(const JsonAt& root)
{
    std::vector<std::string> notes;
    const PlacesOfExtensions extensions(root.json());
    for (const auto& [name, places] : extensions.found())
    {
        const std::string_view left_out = known_extension(name).left_out;
        if (left_out.empty())
        {
            continue;
        }
        const std::string where =
            places.count == 0   ? ""
            : places.count == 1 ? fmt::format(" ({})", places.first)
                                : fmt::format(" ({} and {} more)", places.first, places.count - 1);
        notes.push_back(fmt::format("extension '{}'{} {}", printable(name), where, left_out));
    }
    return notes;
}

} // namespace tactus::detail
