// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/feature_edges.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <tuple>

namespace tactus::bench
{

namespace
{

/// Side of a face, ends in ascending order: sides of one edge differ only in the face.
struct Side
{
    std::uint32_t low;
    std::uint32_t high;
    std::uint32_t face;

    [[nodiscard]] bool is_same_edge(const Side& other) const
    {
        return low == other.low && high == other.high;
    }
};

Vec3 place(const TriangleMesh& mesh, std::uint32_t vertex)
{
    const std::array<double, 3>& at = mesh.positions[vertex];
    return {at[0], at[1], at[2]};
}

Vec3 normal(const TriangleMesh& mesh, std::uint32_t face)
{
    const auto& [a, b, c] = mesh.faces[face];
    return (place(mesh, b) - place(mesh, a)).cross(place(mesh, c) - place(mesh, a));
}

std::vector<Side> sorted_sides(const TriangleMesh& mesh)
{
    std::vector<Side> sides;
    sides.reserve(3 * mesh.faces.size());
    for (std::uint32_t face = 0; face < mesh.faces.size(); ++face)
    {
        for (std::size_t i = 0; i < 3; ++i)
        {
            const auto [low, high] =
                std::minmax({mesh.faces[face][i], mesh.faces[face][(i + 1) % 3]});
            sides.push_back({low, high, face});
        }
    }
    std::sort(sides.begin(), sides.end(),
              [](const Side& a, const Side& b)
              { return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face); });
    return sides;
}

/// Edges that satisfy `is_wanted(sides)`.
template <typename Condition>
std::vector<Segment> edges_where(const TriangleMesh& mesh, const Condition& is_wanted)
{
    const std::vector<Side> sides = sorted_sides(mesh);
    std::vector<Segment> edges;
    for (auto begin = sides.begin(); begin != sides.end();)
    {
        const auto end = std::find_if_not(
            begin, sides.end(), [&](const Side& side) { return side.is_same_edge(*begin); });
        if (is_wanted(std::span(begin, end)))
        {
            edges.push_back({place(mesh, begin->low), place(mesh, begin->high)});
        }
        begin = end;
    }
    return edges;
}

double distance(const Vec3& point, const Segment& segment)
{
    const Vec3 along = segment.to - segment.from;
    const double squared = along.squaredNorm();
    const double share =
        squared > 0.0 ? std::clamp((point - segment.from).dot(along) / squared, 0.0, 1.0) : 0.0;
    return (segment.from + share * along - point).norm();
}

double nearest_distance(const Vec3& point, const std::vector<Segment>& segments)
{
    double least = std::numeric_limits<double>::infinity();
    for (const Segment& segment : segments)
    {
        least = std::min(least, distance(point, segment));
    }
    return least;
}

} // namespace

std::vector<Segment> border_edges(const TriangleMesh& mesh)
{
    return edges_where(mesh, [](std::span<const Side> sides) { return sides.size() == 1; });
}

std::vector<Segment> sharp_edges(const TriangleMesh& mesh, double angle_deg)
{
    const double least_cosine = std::cos(angle_deg / 180.0 * std::numbers::pi);
    const auto is_sharp = [&](std::span<const Side> sides)
    {
        const Vec3 first = normal(mesh, sides.front().face);
        return std::any_of(sides.begin() + 1, sides.end(),
                           [&](const Side& side)
                           {
                               const Vec3 other = normal(mesh, side.face);
                               const double scale = first.norm() * other.norm();
                               return first.dot(other) < least_cosine * scale;
                           });
    };
    return edges_where(mesh, is_sharp);
}

double largest_distance(const std::vector<Segment>& lines, const std::vector<Segment>& others,
                        unsigned points)
{
    double length = 0.0;
    for (const Segment& line : lines)
    {
        length += (line.to - line.from).norm();
    }
    double largest = 0.0;
    for (const Segment& line : lines)
    {
        const Vec3 along = line.to - line.from;
        const auto steps = static_cast<unsigned>(std::ceil(along.norm() * points / length));
        for (unsigned step = 0; step <= steps; ++step)
        {
            const double share = steps == 0 ? 0.0 : static_cast<double>(step) / steps;
            largest = std::max(largest, nearest_distance(line.from + share * along, others));
        }
    }
    return largest;
}

} // namespace tactus::bench
