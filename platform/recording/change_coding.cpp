// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/change_coding.hpp"

#include <array>

namespace tactus
{

namespace
{

void write_pose(FixedWriter& writer, const ObjectPose& pose) noexcept
{
    writer.write_rotation(pose.rotation);
    writer.write_vector(pose.translation_m);
    writer.write(pose.scale);
    writer.write(pose.stamp_ns);
    writer.write(pose.arrival_ns);
    writer.write(pose.revision);
}

/// Values in the order of the format.
constexpr std::array kMaterialValues{&Material::stiffness_n_per_m,   &Material::static_friction,
                                     &Material::dynamic_friction,    &Material::damping_n_s_per_m,
                                     &Material::viscosity_n_s_per_m, &Material::texture_height_m,
                                     &Material::texture_length_m};

void write_material(FixedWriter& writer, const Material& material) noexcept
{
    for (const auto value : kMaterialValues)
    {
        writer.write(material.*value);
    }
}

ObjectPose read_pose(ByteReader& reader)
{
    ObjectPose pose;
    pose.rotation = read_rotation(reader);
    pose.translation_m = read_vector(reader);
    pose.scale = reader.read<double>();
    pose.stamp_ns = reader.read<std::int64_t>();
    pose.arrival_ns = reader.read<std::int64_t>();
    pose.revision = reader.read<std::uint32_t>();
    return pose;
}

Material read_material(ByteReader& reader)
{
    Material material;
    for (const auto value : kMaterialValues)
    {
        material.*value = reader.read<double>();
    }
    return material;
}

} // namespace

void write_change(FixedWriter& writer, const SceneChange& change) noexcept
{
    writer.write(static_cast<std::uint8_t>(change.kind));
    writer.write(change.number);
    writer.write(change.generation);
    if (change.kind == SceneChangeKind::object_comes)
    {
        writer.write(change.object.model.value);
    }
    if (has_material(change.kind))
    {
        write_material(writer, change.object.material);
    }
    if (has_pose(change.kind))
    {
        write_pose(writer, change.pose);
    }
}

bool try_read(ByteReader& reader, SceneChange& change)
{
    const auto kind = reader.read<std::uint8_t>();
    if (kind >= kSceneChangeKinds)
    {
        return false;
    }
    change.kind = static_cast<SceneChangeKind>(kind);
    change.number = reader.read<std::uint32_t>();
    change.generation = reader.read<std::uint32_t>();
    if (change.kind == SceneChangeKind::object_comes)
    {
        change.object.model = ModelId{reader.read<std::uint32_t>()};
    }
    if (has_material(change.kind))
    {
        change.object.material = read_material(reader);
    }
    if (has_pose(change.kind))
    {
        change.pose = read_pose(reader);
    }
    return true;
}

Vec3 read_vector(ByteReader& reader)
{
    Vec3 value;
    for (int axis = 0; axis < 3; ++axis)
    {
        value[axis] = reader.read<double>();
    }
    return value;
}

Mat3 read_rotation(ByteReader& reader)
{
    Mat3 rotation;
    for (int row = 0; row < 3; ++row)
    {
        rotation.row(row) = read_vector(reader).transpose();
    }
    return rotation;
}

} // namespace tactus
