// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/detail/prepare_steps.hpp"
#include "host_tools/mesh/mesh_places.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace tactus::detail
{

namespace
{

/// Maximum number of calls of stitch_once(): each cuts at most one of the three edges of a face.
constexpr int kRoundsMax = 3;
/// Maximum number of cells along an axis: three coordinates fit in 63 bits.
constexpr double kCellsMax = 0x1p20;

/// Border edge: edge `edge`, 0 to 2, of a face; no other face has it.
struct BorderEdge
{
    std::uint32_t face{0};
    std::uint32_t edge{0};
};

/// Marks border vertices. The faces around an inner vertex form a cycle, so the sums of their next
/// and previous corners are equal. Sums of a border vertex differ except by rare chance; then that
/// border is missed.
std::vector<bool> find_border_vertices(const TriangleMesh& mesh)
{
    std::vector<std::uint64_t> mixed(mesh.positions.size());
    for (std::size_t v = 0; v < mixed.size(); ++v)
    {
        const std::uint64_t product = (v + 1) * 0x9E37'79B9'7F4A'7C15U;
        mixed[v] = product ^ product >> 31U;
    }
    std::vector<std::uint64_t> sum(mesh.positions.size(), 0);
    for (const auto& [a, b, c] : mesh.faces)
    {
        sum[a] += mixed[b] - mixed[c];
        sum[b] += mixed[c] - mixed[a];
        sum[c] += mixed[a] - mixed[b];
    }
    std::vector<bool> is_border(sum.size());
    std::transform(sum.begin(), sum.end(), is_border.begin(),
                   [](std::uint64_t rest) { return rest != 0; });
    return is_border;
}

std::vector<BorderEdge> find_border_edges(const TriangleMesh& mesh,
                                          const std::vector<bool>& is_border)
{
    if (std::ranges::find(is_border, true) == is_border.end())
    {
        return {};
    }
    std::vector<std::pair<std::array<std::uint32_t, 2>, BorderEdge>> edges;
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
    {
        for (std::uint32_t k = 0; k < 3; ++k)
        {
            const auto [least, largest] =
                std::minmax({mesh.faces[f][k], mesh.faces[f][(k + 1) % 3]});
            if (is_border[least] && is_border[largest])
            {
                edges.push_back({{least, largest}, {f, k}});
            }
        }
    }
    std::ranges::stable_sort(edges, {}, [](const auto& edge) { return edge.first; });
    std::vector<BorderEdge> single;
    for (std::size_t i = 0; i < edges.size();)
    {
        std::size_t end = i + 1;
        while (end < edges.size() && edges[end].first == edges[i].first)
        {
            ++end;
        }
        if (end == i + 1)
        {
            single.push_back(edges[i].second);
        }
        i = end;
    }
    return single;
}

/// Border vertices in cells of the mean size of a border edge.
class VertexCells
{
public:
    VertexCells(const TriangleMesh& mesh, const std::vector<bool>& is_border,
                const std::vector<BorderEdge>& edges)
    {
        const Eigen::AlignedBox3d box = box_of(mesh);
        low_ = box.min();
        double sum = 0.0;
        for (const auto& [face, edge] : edges)
        {
            const Vec3 from = place_of(mesh, mesh.faces[face][edge]);
            sum += (place_of(mesh, mesh.faces[face][(edge + 1) % 3]) - from).norm();
        }
        cell_ =
            std::max(sum / static_cast<double>(edges.size()), box.sizes().maxCoeff() / kCellsMax);
        for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
        {
            if (is_border[v])
            {
                // Rounding may put a neighbour's vertex outside the box.
                const Vec3 at = ((place_of(mesh, v) - low_) / cell_).cwiseMax(0.0);
                members_.emplace_back(
                    key(std::floor(at.x()), std::floor(at.y()), std::floor(at.z())), v);
            }
        }
        std::ranges::sort(members_);
    }

    /// Calls `visit` with at least each vertex within `tolerance` of the segment; a vertex may be
    /// visited more than once, or be farther away.
    template <typename Visit>
    void visit_near(const Vec3& from, const Vec3& to, double tolerance, const Visit& visit) const
    {
        const Vec3 start = (from - low_) / cell_;
        const Vec3 way = (to - from) / cell_;
        const double margin = tolerance / cell_;
        const auto pieces = std::ceil(way.cwiseAbs().maxCoeff()) + 1.0;
        for (double i = 0.0; i < pieces; i += 1.0)
        {
            const Vec3 a = start + i / pieces * way;
            const Vec3 b = start + (i + 1.0) / pieces * way;
            const Vec3 low = (a.cwiseMin(b).array() - margin).floor().max(0.0).matrix();
            const Vec3 high = (a.cwiseMax(b).array() + margin).floor().matrix();
            for (double x = low.x(); x <= high.x(); x += 1.0)
            {
                for (double y = low.y(); y <= high.y(); y += 1.0)
                {
                    for (double z = low.z(); z <= high.z(); z += 1.0)
                    {
                        visit_cell(key(x, y, z), visit);
                    }
                }
            }
        }
    }

private:
    [[nodiscard]] static std::uint64_t key(double x, double y, double z)
    {
        return (static_cast<std::uint64_t>(x) << 42U) + (static_cast<std::uint64_t>(y) << 21U) +
               static_cast<std::uint64_t>(z);
    }
    template <typename Visit>
    void visit_cell(std::uint64_t cell, const Visit& visit) const
    {
        auto at = std::ranges::lower_bound(members_, std::pair(cell, 0U));
        for (; at != members_.end() && at->first == cell; ++at)
        {
            visit(at->second);
        }
    }

    Vec3 low_{0.0, 0.0, 0.0};
    double cell_{1.0};
    std::vector<std::pair<std::uint64_t, std::uint32_t>> members_;
};

/// Vertices on an edge, each with its distance from the first end of the edge.
using Stops = std::vector<std::pair<double, std::uint32_t>>;

/// Border vertices on the edge except its ends, ordered from its first end.
Stops stops_on(const TriangleMesh& mesh, const VertexCells& cells, const BorderEdge& border,
               double tolerance)
{
    const auto& face = mesh.faces[border.face];
    const Vec3 from = place_of(mesh, face[border.edge]);
    const Vec3 to = place_of(mesh, face[(border.edge + 1) % 3]);
    const Vec3 way = to - from;
    const double length = way.norm();
    Stops stops;
    cells.visit_near(from, to, tolerance,
                     [&](std::uint32_t vertex)
                     {
                         const Vec3 off = place_of(mesh, vertex) - from;
                         const double along = off.dot(way) / length;
                         const bool is_between =
                             along > 2.0 * tolerance && along < length - 2.0 * tolerance;
                         if (is_between && off.cross(way).norm() <= tolerance * length &&
                             std::ranges::find(face, vertex) == face.end())
                         {
                             stops.emplace_back(along, vertex);
                         }
                     });
    std::ranges::sort(stops);
    // Stops without near duplicates: the lowest number stays, so the mesh's own vertices go first.
    Stops apart;
    for (const auto& stop : stops)
    {
        if (apart.empty() || stop.first - apart.back().first > 2.0 * tolerance)
        {
            apart.push_back(stop);
        }
        else if (stop.second < apart.back().second)
        {
            apart.back() = stop;
        }
    }
    return apart;
}

void cut_face(TriangleMesh& mesh, const BorderEdge& border, const Stops& stops)
{
    const auto face = mesh.faces[border.face];
    const std::uint32_t end = face[(border.edge + 1) % 3];
    const std::uint32_t opposite = face[(border.edge + 2) % 3];
    mesh.faces[border.face] = {face[border.edge], stops.front().second, opposite};
    for (std::size_t i = 0; i < stops.size(); ++i)
    {
        const std::uint32_t next = i + 1 < stops.size() ? stops[i + 1].second : end;
        mesh.faces.push_back({stops[i].second, next, opposite});
    }
}

/// Cuts at most one edge of each face; returns the number of added faces.
std::size_t stitch_once(TriangleMesh& mesh, double tolerance, std::size_t first_beside)
{
    std::vector<bool> is_border = find_border_vertices(mesh);
    std::fill(is_border.begin() + static_cast<std::ptrdiff_t>(first_beside), is_border.end(), true);
    const std::vector<BorderEdge> edges = find_border_edges(mesh, is_border);
    if (edges.empty())
    {
        return 0;
    }
    const VertexCells cells(mesh, is_border, edges);
    const std::size_t before = mesh.faces.size();
    std::vector<bool> is_cut(before, false);
    for (const BorderEdge& edge : edges)
    {
        if (is_cut[edge.face])
        {
            continue;
        }
        const Stops stops = stops_on(mesh, cells, edge, tolerance);
        if (!stops.empty())
        {
            is_cut[edge.face] = true;
            cut_face(mesh, edge, stops);
        }
    }
    return mesh.faces.size() - before;
}

/// New place of each vertex: the first border vertex within the tolerance that stays in place, or
/// the vertex itself.
std::vector<std::uint32_t> first_near(const TriangleMesh& mesh, const std::vector<bool>& is_border,
                                      const VertexCells& cells, double tolerance)
{
    std::vector<std::uint32_t> first(mesh.positions.size());
    std::iota(first.begin(), first.end(), 0U);
    for (std::uint32_t v = 0; v < first.size(); ++v)
    {
        const Vec3 at = place_of(mesh, v);
        const auto take = [&](std::uint32_t other)
        {
            if (other < first[v] && first[other] == other &&
                (place_of(mesh, other) - at).norm() <= tolerance)
            {
                first[v] = other;
            }
        };
        if (is_border[v])
        {
            cells.visit_near(at, at, tolerance, take);
        }
    }
    return first;
}

} // namespace

JoinedBorders join_borders(TriangleMesh& mesh, double tolerance)
{
    const std::vector<bool> is_border = find_border_vertices(mesh);
    const std::vector<BorderEdge> edges = find_border_edges(mesh, is_border);
    JoinedBorders joined{.are_there = !edges.empty()};
    if (!joined.are_there)
    {
        return joined;
    }
    std::vector<std::uint32_t> first =
        first_near(mesh, is_border, VertexCells(mesh, is_border, edges), tolerance);
    for (const auto& face : mesh.faces)
    {
        for (std::size_t k = 0; k < 3; ++k)
        {
            const std::uint32_t next = face[(k + 1) % 3];
            if (first[face[k]] == first[next])
            {
                first[face[k]] = face[k];
                first[next] = next;
            }
        }
    }
    for (std::uint32_t v = 0; v < first.size(); ++v)
    {
        if (first[v] != v)
        {
            const double off = (place_of(mesh, v) - place_of(mesh, first[v])).norm();
            joined.farthest = std::max(joined.farthest, off);
            ++joined.vertices;
            mesh.positions[v] = mesh.positions[first[v]];
        }
    }
    return joined;
}

std::size_t stitch_edges(TriangleMesh& mesh, double tolerance, std::size_t first_beside)
{
    std::size_t added = 0;
    for (int round = 0; round < kRoundsMax; ++round)
    {
        const std::size_t more = stitch_once(mesh, tolerance, first_beside);
        added += more;
        if (more == 0)
        {
            break;
        }
    }
    return added;
}

} // namespace tactus::detail
