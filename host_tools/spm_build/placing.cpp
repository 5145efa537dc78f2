// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_build/placing.hpp"

#include "rt_core/limits.hpp"
#include "rt_core/math/vec3.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <numbers>

namespace tactus::spm_build
{

namespace
{

void turn_y_up(Pose& pose)
{
    const auto [x, y, z] = pose.translation_m;
    pose.translation_m = {x, -z, y};
    Eigen::Map<Eigen::Quaterniond> rotation(pose.rotation.data());
    const Eigen::AngleAxisd upright(std::numbers::pi / 2.0, Eigen::Vector3d::UnitX());
    rotation = (Eigen::Quaterniond(upright) * rotation).normalized();
}

/// Middle, in the world, of the boxes of all objects in their poses.
Vec3 middle_of(std::span<const Eigen::AlignedBox3d> boxes, std::span<const PlacedModel> objects)
{
    Eigen::AlignedBox3d all;
    for (const PlacedModel& object : objects)
    {
        const Pose& pose = object.pose;
        const Eigen::Quaterniond rotation(pose.rotation.data());
        for (int corner = 0; corner < 8; ++corner)
        {
            const Vec3 place =
                boxes[object.model].corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
            all.extend(pose.scale * (rotation * place) + Vec3(pose.translation_m.data()));
        }
    }
    return all.center();
}

} // namespace

void turn_y_up(TriangleMesh& mesh)
{
    for (auto& [x, y, z] : mesh.positions)
    {
        const double up = y;
        y = -z;
        z = up;
    }
}

std::optional<Refusal> place_objects(const Placing& placing,
                                     std::span<const Eigen::AlignedBox3d> boxes,
                                     std::vector<PlacedModel>& objects,
                                     std::vector<std::string>& notes)
{
    for (PlacedModel& object : objects)
    {
        if (placing.is_y_up)
        {
            turn_y_up(object.pose);
        }
        object.pose.scale *= placing.scale;
        for (double& coordinate : object.pose.translation_m)
        {
            coordinate *= placing.scale;
        }
    }
    if (placing.is_centered)
    {
        const Vec3 middle = middle_of(boxes, objects);
        for (PlacedModel& object : objects)
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                object.pose.translation_m[axis] -= middle[static_cast<Eigen::Index>(axis)];
            }
        }
        notes.push_back(fmt::format("moved by {:.9g}, {:.9g}, {:.9g} m to the origin", -middle.x(),
                                    -middle.y(), -middle.z()));
    }
    for (PlacedModel& object : objects)
    {
        const auto checked = checked_pose(object.pose);
        if (!checked)
        {
            return Refusal{
                fmt::format("--scale: object '{}' would {}", object.name,
                            checked.error() == PoseRefusal::scale
                                ? fmt::format("have a scale of {:.6g}; {} to {} is allowed",
                                              object.pose.scale, kPoseScaleMin, kPoseScaleMax)
                                : fmt::format("lie farther than {} m from the origin along an axis",
                                              kPoseReachMax_m))};
        }
        object.pose = checked.value();
    }
    return std::nullopt;
}

} // namespace tactus::spm_build
