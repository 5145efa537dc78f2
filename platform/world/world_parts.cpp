// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/world/world_parts.hpp"

#include <fmt/format.h>

#include <utility>

namespace tactus
{

WorldModel model_file(std::string path)
{
    return {.kind = WorldModel::Kind::file, .text = std::move(path)};
}

WorldModel mesh_file(std::string path, MeshOptions options)
{
    return {.kind = WorldModel::Kind::mesh_file,
            .text = std::move(path),
            .options = std::move(options)};
}

WorldModel mesh(std::vector<std::array<double, 3>> vertices,
                std::vector<std::array<std::uint32_t, 3>> faces, MeshOptions options)
{
    return {.kind = WorldModel::Kind::mesh,
            .options = std::move(options),
            .vertices = std::move(vertices),
            .faces = std::move(faces)};
}

WorldModel published(std::string name)
{
    return {.kind = WorldModel::Kind::published, .text = std::move(name)};
}

// Numbers in words keep all their bits.

WorldTool point()
{
    return {.words = "point"};
}

WorldTool sphere(double radius_m)
{
    return {.words = fmt::format("sphere:{}", radius_m)};
}

WorldTool capsule(double radius_m, double length_m)
{
    return {.words = fmt::format("capsule:{},{}", radius_m, length_m)};
}

WorldTool box(double x_m, double y_m, double z_m, double radius_m)
{
    return {.words = fmt::format("box:{},{},{},{}", x_m, y_m, z_m, radius_m)};
}

WorldTool hull(std::vector<std::array<double, 3>> corners, double radius_m)
{
    return {.radius_m = radius_m, .corners = std::move(corners)};
}

WorldTool mesh_tool(WorldModel model, double radius_m)
{
    return {.radius_m = radius_m, .model = std::move(model)};
}

WorldTool tool(std::string words)
{
    return {.words = std::move(words)};
}

WorldDevice device(std::string words, DeviceOptions options)
{
    return {.words = std::move(words), .options = std::move(options)};
}

WorldDevice device(std::shared_ptr<HapticDevice> own)
{
    return {.own = std::move(own)};
}

WorldDevice by_program(DeviceOptions options)
{
    return {.options = std::move(options), .is_program = true};
}

} // namespace tactus
