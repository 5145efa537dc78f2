// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/report/report.hpp"
#include "rt_core/math/triangle.hpp"
#include "rt_core/spm/base_mesh.hpp"
#include "rt_core/spm/header.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <variant>
#include <vector>

namespace tactus::hrtc
{

namespace
{

/// Reach of a search beyond the tool's radius: kReachShare of the radius, plus kWay_m, the way of a
/// hand of 0.1 m/s in a millisecond.
constexpr double kReachShare = 0.05;
constexpr double kWay_m = 1e-4;
/// Faces in the pools for each searched face. Measured: 5 to 18 (boxes, capsules and spheres of 2
/// to 16 mm on 1.3 M faces).
constexpr double kKeptPerFace = 8.0;

/// Outline of a core that lies flat on a surface: area, and length of the rim.
struct Outline
{
    double area_m2;
    double rim_m;
};

/// Outline of the largest side of a box.
Outline outline_of(const Vec3& edges_m)
{
    std::array<double, 3> edges{edges_m.x(), edges_m.y(), edges_m.z()};
    std::ranges::sort(edges);
    return {edges[1] * edges[2], 2.0 * (edges[1] + edges[2])};
}

Outline outline_of(const ToolCore& core)
{
    if (const auto* segment = std::get_if<Segment>(&core))
    {
        return {0.0, 2.0 * (segment->to - segment->from).norm()};
    }
    if (const auto* box = std::get_if<Box>(&core))
    {
        return outline_of(Vec3(2.0 * box->half));
    }
    if (const auto* hull = std::get_if<Hull>(&core))
    {
        Vec3 low = hull->vertices()[0];
        Vec3 high = low;
        for (const Vec3& vertex : hull->vertices())
        {
            low = low.cwiseMin(vertex);
            high = high.cwiseMax(vertex);
        }
        return outline_of(Vec3(high - low));
    }
    return {0.0, 0.0};
}

} // namespace

FaceDensity face_density(const ServedModel& model)
{
    const auto header = ModelHeader::parse(model.header);
    if (!header)
    {
        return {};
    }
    const auto faces_in_all = static_cast<double>(header.value().fields().source_faces);
    const ModelCounts counts = header.value().counts();
    std::vector<Vec3f> positions_m(counts.base_vertices);
    std::vector<BaseFace> faces(counts.base_faces);
    std::vector<std::uint32_t> next(counts.base_faces);
    if (!parse_base_mesh(model.base, header.value(), {positions_m, faces, next}))
    {
        return {faces_in_all, 0.0};
    }
    double area_m2 = 0.0;
    for (const BaseFace& face : faces)
    {
        const auto corner = [&](std::size_t i)
        { return to_vec3(positions_m[face.corners[i].value]); };
        area_m2 += 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
    }
    return {faces_in_all, area_m2 > 0.0 ? faces_in_all / area_m2 : 0.0};
}

double faces_under(const ToolSpec& tool, double faces_per_m2)
{
    if (std::holds_alternative<MeshCore>(tool.core))
    {
        return 0.0;
    }
    const Outline outline = outline_of(tool.core);
    const double reach_m = tool.radius_m * (1.0 + kReachShare) + kWay_m;
    const double aside_m = std::sqrt(reach_m * reach_m - tool.radius_m * tool.radius_m);
    const double area_m2 =
        outline.area_m2 + outline.rim_m * aside_m + std::numbers::pi * aside_m * aside_m;
    return area_m2 * faces_per_m2;
}

Footprint footprint_of(const ToolSpec& tool, const FaceDensity& density, double scale)
{
    const double faces = faces_under(tool, density.per_m2 / (scale * scale));
    return {std::min(faces, density.faces), std::min(kKeptPerFace * faces, density.faces)};
}

} // namespace tactus::hrtc
