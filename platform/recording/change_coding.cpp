// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/setup_coding.hpp"

#include <array>
#include <cstdint>

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

namespace
{

/// Flags: the first four are values, all later ones announce fields that follow in this order.
enum ToolFlag : std::uint16_t
{
    kIsValid = 1U << 0U,
    kIsConnected = 1U << 1U,
    kIsHeld = 1U << 2U,
    kMeasuresRotation = 1U << 3U,
    kHasRotation = 1U << 4U,
    kHasPose = 1U << 5U,
    kHasVelocity = 1U << 6U,
    kHasAngularVelocity = 1U << 7U,
    kHasButtons = 1U << 8U,
    kHasGripper = 1U << 9U,
    kHasForce = 1U << 10U,
    kHasTorque = 1U << 11U,
    kHasGripperForce = 1U << 12U,
};

const Vec3 kNothing(0.0, 0.0, 0.0);

std::uint16_t flags_of(const ToolState& tool, const DeviceRecord& device) noexcept
{
    unsigned flags = 0;
    const auto set = [&flags](bool is_so, ToolFlag flag) { flags |= is_so ? unsigned{flag} : 0U; };
    set(tool.valid, kIsValid);
    set(device.connected, kIsConnected);
    set(device.deadman_held, kIsHeld);
    set(device.measures_rotation, kMeasuresRotation);
    set(tool.rotation != Mat3::Identity(), kHasRotation);
    set(device.pose.has_value(), kHasPose);
    set(device.velocity_m_per_s.has_value(), kHasVelocity);
    set(device.angular_velocity_rad_per_s.has_value(), kHasAngularVelocity);
    set(device.buttons != 0, kHasButtons);
    set(device.gripper_m.has_value(), kHasGripper);
    set(device.sent_n != kNothing, kHasForce);
    set(device.sent_nm != kNothing, kHasTorque);
    set(device.sent_gripper_n != 0.0, kHasGripperForce);
    return static_cast<std::uint16_t>(flags);
}

} // namespace

void write_tool(FixedWriter& writer, const ToolState& tool, const DeviceRecord& device) noexcept
{
    const std::uint16_t flags = flags_of(tool, device);
    writer.write_vector(tool.position_m);
    writer.write(tool.sample_time_ns);
    writer.write(tool.elapsed_periods);
    writer.write(flags);
    if ((flags & kHasRotation) != 0)
    {
        writer.write_rotation(tool.rotation);
    }
    if (device.pose)
    {
        writer.write_vector(device.pose->position_m);
        writer.write_rotation(device.pose->rotation);
    }
    for (const std::optional<Vec3>& velocity :
         {device.velocity_m_per_s, device.angular_velocity_rad_per_s})
    {
        if (velocity)
        {
            writer.write_vector(*velocity);
        }
    }
    if ((flags & kHasButtons) != 0)
    {
        writer.write(device.buttons);
    }
    if (device.gripper_m)
    {
        writer.write(*device.gripper_m);
    }
    if ((flags & kHasForce) != 0)
    {
        writer.write_vector(device.sent_n);
    }
    if ((flags & kHasTorque) != 0)
    {
        writer.write_vector(device.sent_nm);
    }
    if ((flags & kHasGripperForce) != 0)
    {
        writer.write(device.sent_gripper_n);
    }
}

bool try_read_tool(ByteReader& reader, ToolState& tool, DeviceRecord& device)
{
    tool = {};
    device = {};
    tool.position_m = read_vector(reader);
    tool.sample_time_ns = reader.read<std::int64_t>();
    tool.elapsed_periods = reader.read<std::uint32_t>();
    const auto flags = reader.read<std::uint16_t>();
    const auto has = [flags](ToolFlag flag) { return (flags & flag) != 0; };
    tool.valid = has(kIsValid);
    device.connected = has(kIsConnected);
    device.deadman_held = has(kIsHeld);
    device.measures_rotation = has(kMeasuresRotation);
    if (has(kHasRotation))
    {
        tool.rotation = read_rotation(reader);
    }
    if (has(kHasPose))
    {
        DevicePose& pose = device.pose.emplace();
        pose.position_m = read_vector(reader);
        pose.rotation = read_rotation(reader);
    }
    if (has(kHasVelocity))
    {
        device.velocity_m_per_s = read_vector(reader);
    }
    if (has(kHasAngularVelocity))
    {
        device.angular_velocity_rad_per_s = read_vector(reader);
    }
    device.buttons = has(kHasButtons) ? reader.read<std::uint32_t>() : 0;
    if (has(kHasGripper))
    {
        device.gripper_m = reader.read<double>();
    }
    device.sent_n = has(kHasForce) ? read_vector(reader) : kNothing;
    device.sent_nm = has(kHasTorque) ? read_vector(reader) : kNothing;
    device.sent_gripper_n = has(kHasGripperForce) ? reader.read<double>() : 0.0;
    return flags == flags_of(tool, device);
}

} // namespace tactus
