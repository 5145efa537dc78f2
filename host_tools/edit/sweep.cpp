// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/edit/sweep.hpp"

#include "rt_core/math/rotation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace tactus
{

namespace
{

/// Least thickness of a tool: a thinner one could be withdrawn to nothing.
constexpr double kLeastThickness_quanta = 16.0;
/// Largest coordinate of a region; beyond it, shifts would be lost in a double's rounding.
constexpr double kFarthest_quanta = 0x1p30;
/// Points that lie at most this far outside the hull of the others are left out.
constexpr double kHullMargin_quanta = 4.0 * kSweptShift_quanta;
/// Least cosine between the normals of a facet and a face that it runs along, of either sign.
constexpr double kAlongCosine = 0.8;
/// Edges into which each edge of an icosahedron is cut for a sphere.
constexpr int kSphereCuts = 3;
/// Distance on the unit sphere up to which two points are the same one, computed from two facets.
constexpr double kSameSpherePoint = 1e-6;

/// Well-mixed number in -1 .. 1 for each index.
double shift_of(std::uint64_t seed, std::uint64_t index)
{
    std::uint64_t bits = (seed + 1) * 0x9E37'79B9'7F4A'7C15ULL + index * 0xD1B5'4A32'D192'ED03ULL;
    bits = (bits ^ (bits >> 32U)) * 0xBF58'476D'1CE4'E5B9ULL;
    bits = (bits ^ (bits >> 29U)) * 0x94D0'49BB'1331'11EBULL;
    return static_cast<double>((bits ^ (bits >> 32U)) >> 11U) * 0x1p-52 - 1.0;
}

/// Points of a subdivided icosahedron, scaled so that its hull lies as far inside the unit sphere
/// as outside of it.
std::vector<Vec3> sphere_points()
{
    const double golden = (1.0 + std::sqrt(5.0)) / 2.0;
    std::vector<Vec3> corners;
    for (const double one : {-1.0, 1.0})
    {
        for (const double wide : {-golden, golden})
        {
            corners.emplace_back(0.0, one, wide);
            corners.emplace_back(one, wide, 0.0);
            corners.emplace_back(wide, 0.0, one);
        }
    }
    std::vector<Vec3> points;
    const Polyhedron icosahedron = convex_hull(corners, 0.0);
    for (const auto& facet : icosahedron.facets)
    {
        for (int i = 0; i <= kSphereCuts; ++i)
        {
            for (int k = 0; i + k <= kSphereCuts; ++k)
            {
                const Vec3 sum = icosahedron.vertices[facet[0]] * i +
                                 icosahedron.vertices[facet[1]] * k +
                                 icosahedron.vertices[facet[2]] * (kSphereCuts - i - k);
                const Vec3 point = sum.normalized();
                const bool is_new = std::none_of(points.begin(), points.end(),
                                                 [&](const Vec3& p)
                                                 { return (p - point).norm() < kSameSpherePoint; });
                if (is_new)
                {
                    points.push_back(point);
                }
            }
        }
    }
    double inner = 1.0;
    const Polyhedron hull = convex_hull(points, 0.0);
    for (const auto& facet : hull.facets)
    {
        const Vec3& a = hull.vertices[facet[0]];
        const Vec3 normal =
            (hull.vertices[facet[1]] - a).cross(hull.vertices[facet[2]] - a).normalized();
        inner = std::min(inner, normal.dot(a));
    }
    for (Vec3& point : points)
    {
        point *= 2.0 / (1.0 + inner);
    }
    return points;
}

/// True if a corner of one is within `distance` of the other.
bool are_near(const Triangle& a, const Triangle& b, double distance)
{
    for (Eigen::Index axis = 0; axis < 3; ++axis)
    {
        const auto [low_a, high_a] = std::minmax({a[0][axis], a[1][axis], a[2][axis]});
        const auto [low_b, high_b] = std::minmax({b[0][axis], b[1][axis], b[2][axis]});
        if (low_a > high_b + distance || low_b > high_a + distance)
        {
            return false;
        }
    }
    const auto reaches = [&](const Triangle& from, const Triangle& to)
    {
        return std::any_of(
            from.begin(), from.end(),
            [&](const Vec3& corner)
            { return closest_point_on_triangle(corner, to).distance_sq < distance * distance; });
    };
    return reaches(a, b) || reaches(b, a);
}

std::optional<std::string> fault_of(const Sweep& sweep)
{
    const std::size_t core = sweep.core_m.size();
    const bool is_finite = std::isfinite(sweep.radius_m) && sweep.from_m.allFinite() &&
                           sweep.to_m.allFinite() && sweep.rotation.allFinite() &&
                           std::all_of(sweep.core_m.begin(), sweep.core_m.end(),
                                       [](const Vec3& point) { return point.allFinite(); });
    if (!is_finite)
    {
        return "sweep: a number is not finite";
    }
    if (core == 0 || core == 3 || core > kMaxSweptVertices)
    {
        return fmt::format("sweep: {} points of core: 1, 2 or 4 to {} are allowed", core,
                           kMaxSweptVertices);
    }
    if (core <= 2 ? !(sweep.radius_m > 0.0) : sweep.radius_m != 0.0)
    {
        return fmt::format("sweep: radius {} m: {} is allowed", sweep.radius_m,
                           core <= 2 ? "a positive one" : "0 for a hull");
    }
    if (!is_rotation(sweep.rotation, kOrthonormalRounding))
    {
        return "sweep: the rotation is not a rotation matrix";
    }
    return std::nullopt;
}

} // namespace

Result<SweptRegion, Refusal> swept_region(const Sweep& sweep, const SurfaceGrid& grid,
                                          std::uint64_t seed)
{
    if (auto fault = fault_of(sweep))
    {
        return Refusal{*std::move(fault)};
    }
    static const std::vector<Vec3> sphere = sphere_points();
    static const std::vector<Vec3> alone{Vec3(0.0, 0.0, 0.0)};
    const bool is_round = sweep.core_m.size() <= 2;
    const double radius_quanta = sweep.radius_m / grid.quantum_m;
    std::vector<Vec3> points;
    for (const Vec3& place_m : {sweep.from_m, sweep.to_m})
    {
        for (const Vec3& core_m : sweep.core_m)
        {
            const Vec3 middle = grid.to_quanta(place_m + sweep.rotation * core_m);
            for (const Vec3& direction : is_round ? sphere : alone)
            {
                Vec3 point = middle + direction * radius_quanta;
                for (Eigen::Index axis = 0; axis < 3; ++axis)
                {
                    point[axis] +=
                        kSweptShift_quanta / 2.0 *
                        shift_of(seed, 3 * points.size() + static_cast<std::size_t>(axis));
                }
                points.push_back(point);
            }
        }
        if (sweep.from_m == sweep.to_m)
        {
            break;
        }
    }
    const bool is_near = std::all_of(points.begin(), points.end(),
                                     [](const Vec3& point)
                                     { return point.cwiseAbs().maxCoeff() <= kFarthest_quanta; });
    if (!is_near)
    {
        return Refusal{fmt::format("sweep: farther than {:.3g} m from the model",
                                   kFarthest_quanta * grid.quantum_m)};
    }
    SweptRegion region{convex_hull(points, kHullMargin_quanta),
                       std::max(1.0, kSweptRoundness / 2.0 * radius_quanta)};
    const bool is_thin = is_round ? 2.0 * radius_quanta < kLeastThickness_quanta
                                  : convex_hull(points, kLeastThickness_quanta).facets.empty();
    if (is_thin)
    {
        return Refusal{fmt::format("sweep: the tool is thinner than {:.3g} m",
                                   kLeastThickness_quanta * grid.quantum_m)};
    }
    return region;
}

void withdraw_from(std::span<const Triangle> faces, CutSense sense,
                   const std::function<bool(const Vec3&)>& is_solid, SweptRegion& region)
{
    std::vector<Vec3>& vertices = region.polyhedron.vertices;
    const double touch = region.slack_quanta + kSweptTouch_quanta;
    const double move = kSweptMoveShare * region.slack_quanta + kSweptMove_quanta;
    std::vector<Vec3> normals(vertices.size(), Vec3(0.0, 0.0, 0.0));
    std::vector<double> moves(vertices.size(), 0.0);
    std::vector<Vec3> face_normals;
    for (const Triangle& face : faces)
    {
        face_normals.push_back((face[1] - face[0]).cross(face[2] - face[0]).normalized());
    }
    for (const auto& corners : region.polyhedron.facets)
    {
        const Triangle facet{vertices[corners[0]], vertices[corners[1]], vertices[corners[2]]};
        const Vec3 area = (facet[1] - facet[0]).cross(facet[2] - facet[0]);
        const Vec3 normal = area.normalized();
        for (const std::uint32_t vertex : corners)
        {
            normals[vertex] += area;
        }
        for (std::size_t i = 0; i < faces.size(); ++i)
        {
            const double cosine = normal.dot(face_normals[i]);
            if (std::abs(cosine) < kAlongCosine || !are_near(facet, faces[i], touch))
            {
                continue;
            }
            const double outward = (sense == CutSense::carve) == (cosine > 0.0) ? move : -move;
            for (const std::uint32_t vertex : corners)
            {
                const bool is_near =
                    closest_point_on_triangle(vertices[vertex], faces[i]).distance_sq <
                    touch * touch;
                if (moves[vertex] == 0.0 && (is_near || !is_solid(vertices[vertex])))
                {
                    moves[vertex] = outward;
                }
            }
        }
    }
    if (std::all_of(moves.begin(), moves.end(), [](double by) { return by == 0.0; }))
    {
        return;
    }
    for (std::size_t i = 0; i < vertices.size(); ++i)
    {
        vertices[i] += moves[i] * normals[i].normalized();
    }
    region.polyhedron = convex_hull(std::vector<Vec3>(vertices), kHullMargin_quanta);
}

} // namespace tactus
