// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_build/size_notes.hpp"

#include "host_tools/mesh/mesh_places.hpp"
#include "host_tools/mesh/prepare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tactus::spm_build
{

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
