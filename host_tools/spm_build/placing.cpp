// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_build/placing.hpp"

#include "host_tools/mesh/mesh_places.hpp"
#include "host_tools/mesh/prepare.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/vec3.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

namespace
{

/// Range of the usual diagonals of touched models.
constexpr double kLeastUsual_m = 1e-3;
constexpr double kMostUsual_m = 10.0;
/// Maximum ratio of a terrain's least extent to its largest; a mask or a relief has a higher ratio.
constexpr double kTerrainRelief = 0.3;
/// Minimum share of a terrain's projected area that faces one way: it has hardly any overhang.
constexpr double kTerrainOneWay = 0.999;
/// Distance from the origin, in diagonals of the model, beyond which a user who starts at the
/// origin finds nothing.
constexpr double kFarDiagonals = 10.0;

bool is_usual(double diagonal_m)
{
    return diagonal_m >= kLeastUsual_m && diagonal_m <= kMostUsual_m;
}

/// Values of --unit that make the size usual, such as "mm (0.39 m) or cm (3.9 m)"; empty if there
/// are none.
std::string better_units(const ModelPlace& place)
{
    std::vector<std::string> ways;
    for (const char* unit : {"mm", "cm", "in", "m"})
    {
        const double other_m = place.diagonal_m / place.metres_per_unit * *metres_per_unit(unit);
        if (is_usual(other_m))
        {
            ways.push_back(fmt::format("{} ({:.2g} m)", unit, other_m));
        }
    }
    std::string text;
    for (std::size_t i = 0; i < ways.size(); ++i)
    {
        text += (i == 0 ? "" : i + 1 < ways.size() ? ", " : " or ") + ways[i];
    }
    return text;
}

} // namespace

bool is_like_terrain(const TriangleMesh& mesh)
{
    Vec3 sum = Vec3::Zero();      // Projected areas along each axis.
    Vec3 absolute = Vec3::Zero(); // The same areas without their signs.
    for (const auto& [a, b, c] : mesh.faces)
    {
        const Vec3 from = place_of(mesh, a);
        const Vec3 area = (place_of(mesh, b) - from).cross(place_of(mesh, c) - from);
        sum += area;
        absolute += area.cwiseAbs();
    }
    const Vec3 extents = box_of(mesh).sizes();
    Eigen::Index up = 0;
    const double height = extents.minCoeff(&up);
    return height > 0.0 && height <= kTerrainRelief * extents.maxCoeff() &&
           std::abs(sum[up]) >= kTerrainOneWay * absolute[up];
}

std::vector<std::string> size_notes(const TriangleMesh& mesh, const ModelPlace& place,
                                    bool has_own_size)
{
    std::vector<std::string> notes;
    const bool is_plausible =
        is_usual(place.diagonal_m) || (place.diagonal_m > kMostUsual_m && is_like_terrain(mesh));
    if (!has_own_size && !is_plausible)
    {
        const std::string units = better_units(place);
        notes.push_back(units.empty() ? fmt::format("the model is {:.6g} m across; if this size is "
                                                    "wrong, set --unit, --scale or --fit-diag",
                                                    place.diagonal_m)
                                      : fmt::format("the model is {:.6g} m across; if this size is "
                                                    "wrong, set --unit {}, --scale or --fit-diag",
                                                    place.diagonal_m, units));
    }
    // Distance of the origin from the box, along the axis on which it is greatest.
    double nearest_m = 0.0;
    for (const double low : place.low_corner_m)
    {
        nearest_m = std::max({nearest_m, low, -(low + place.diagonal_m)});
    }
    if (nearest_m > kFarDiagonals * place.diagonal_m)
    {
        notes.push_back(fmt::format("the model lies {:.6g} m from its origin, {:.0f} times its "
                                    "size; --center moves the model to the origin",
                                    nearest_m, nearest_m / place.diagonal_m));
    }
    return notes;
}

} // namespace tactus::spm_build
