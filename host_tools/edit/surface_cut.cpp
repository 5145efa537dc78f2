// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// The surface and the polyhedron are two meshes of triangles. Their faces meet in segments; a
/// segment's ends lie where an edge of one mesh crosses a face of the other. On each face, the
/// segments and the parts of its edges that remain form closed loops, which are filled with
/// triangles.
///
/// Orientation. T is a face, F a facet. On T the part outside the polyhedron is kept, so a segment
/// starts where an edge of T, followed counter-clockwise, enters the polyhedron. On F the part
/// inside the solid lies on the left of the same direction: a segment ends where an edge of F,
/// followed counter-clockwise, enters the solid. The facets' parts are then turned over for a
/// carve, so that each segment is used once in each direction.
///
/// Exactness. Vertices of the polyhedron are shifted at random, so four points of both meshes lie
/// in a plane by accident only. If they do, the caller shifts them again. The shape of a loop may
/// still be wrong by rounding, which matters for neither orientation nor closedness
/// (loop_triangles.cpp).

#include "host_tools/edit/surface_cut.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/math/orientation.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <unordered_map>

namespace tactus
{

namespace
{

constexpr std::uint32_t kNoNode = 0xFFFF'FFFFU;
/// Share of an edge by which its entry may seem to lie behind its exit. With more, the edge misses
/// the polyhedron; with less, exact tests decide.
constexpr double kEntryAfterExit = 1e-6;

struct Vec3Hash
{
    std::size_t operator()(const std::array<double, 3>& point) const noexcept
    {
        std::uint64_t hash = 0;
        for (const double value : point)
        {
            hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x9E37'79B9'7F4A'7C15ULL;
            hash ^= hash >> 29U;
        }
        return static_cast<std::size_t>(hash);
    }
};

constexpr std::uint64_t key_of(std::uint32_t from, std::uint32_t to)
{
    return std::uint64_t{from} << 32U | to;
}

/// -1, 0 or 1 as side_of_plane() of all three edges if they agree, otherwise 0. `met_zero` is set
/// if one of the sides is zero.
int common_side(const std::array<int, 3>& sides, bool& met_zero)
{
    met_zero |= sides[0] == 0 || sides[1] == 0 || sides[2] == 0;
    return sides[0] == sides[1] && sides[1] == sides[2] ? sides[0] : 0;
}

/// 1 if the segment enters the face from its front, -1 if it leaves, 0 if it misses.
int crossing_of(const Vec3& from, const Vec3& to, const Triangle& face, bool& met_zero)
{
    const PlaneSides plane(face[0], face[1], face[2]);
    const int start = plane.side_of(from);
    const int end = plane.side_of(to);
    if (start == end)
    {
        return 0; // Also in the plane of a face without area.
    }
    met_zero |= start == 0 || end == 0;
    return common_side(sides_of_edges(from, to, face), met_zero) == 0 ? 0 : start;
}

bool boxes_meet(const Vec3& a, const Vec3& b, const Triangle& face)
{
    for (Eigen::Index axis = 0; axis < 3; ++axis)
    {
        const auto [low, high] = std::minmax({face[0][axis], face[1][axis], face[2][axis]});
        if (std::max(a[axis], b[axis]) < low || std::min(a[axis], b[axis]) > high)
        {
            return false;
        }
    }
    return true;
}

class Cutter
{
public:
    Cutter(std::span<const CutFace> faces, const Polyhedron& tool, CutSense sense)
        : faces_(faces), tool_(tool), sense_(sense)
    {
    }

    [[nodiscard]] std::optional<SurfaceCut> run(std::optional<int> winding)
    {
        index_tool();
        index_vertices();
        classify();
        for (std::uint32_t face = 0; face < faces_.size() && !met_zero_; ++face)
        {
            if (may_meet_[face])
            {
                cross_edges(face);
                cross_face(face);
            }
        }
        for (std::uint32_t face = 0; face < faces_.size() && !met_zero_; ++face)
        {
            if (may_meet_[face])
            {
                collect_segments(face);
            }
        }
        if (met_zero_)
        {
            return std::nullopt;
        }
        finish_faces();
        set_windings(winding ? winding : seen_winding());
        if (met_zero_)
        {
            return std::nullopt;
        }
        finish_facets();
        return std::move(result_);
    }

private:
    /// Where an edge of a face crosses a facet.
    struct EdgeCrossing
    {
        std::uint32_t facet{0};
        std::uint32_t node{kNoNode};
    };
    /// The crossings of an edge, followed from its lower to its higher vertex.
    struct Edge
    {
        EdgeCrossing entry;
        EdgeCrossing exit;
    };
    /// Where an edge of the polyhedron crosses a face.
    struct ToolCrossing
    {
        double along{0.0}; ///< 0 at the edge's lower vertex, 1 at the higher.
        int sense{0};      ///< 1 if the edge enters the solid there.
        std::uint32_t node{kNoNode};
        std::uint32_t face{0};
    };
    /// An edge of the polyhedron from its lower vertex to its higher one.
    struct ToolEdge
    {
        std::array<std::uint32_t, 2> ends{};
        /// Facets that contain the edge in this direction, and in the opposite one.
        std::array<std::uint32_t, 2> facets{};
        std::vector<ToolCrossing> crossings{};
    };
    /// Part of a border of a region: from node to node.
    struct Step
    {
        std::uint32_t from{kNoNode};
        std::uint32_t to{kNoNode};
    };

    void index_tool()
    {
        std::unordered_map<std::uint64_t, std::uint32_t> found;
        for (std::uint32_t facet = 0; facet < tool_.facets.size(); ++facet)
        {
            const auto& corners = tool_.facets[facet];
            const Vec3& a = tool_.vertices[corners[0]];
            normals_.push_back(
                (tool_.vertices[corners[1]] - a).cross(tool_.vertices[corners[2]] - a));
            for (std::size_t i = 0; i < 3; ++i)
            {
                const std::uint32_t from = corners[i];
                const std::uint32_t to = corners[(i + 1) % 3];
                const auto [at, is_new] =
                    found.try_emplace(key_of(std::min(from, to), std::max(from, to)),
                                      static_cast<std::uint32_t>(tool_edges_.size()));
                if (is_new)
                {
                    tool_edges_.push_back({{std::min(from, to), std::max(from, to)}, {}, {}});
                }
                tool_edges_[at->second].facets[from < to ? 0 : 1] = facet;
                facet_edges_.push_back(at->second);
            }
        }
        tool_nodes_.assign(tool_.vertices.size(), kNoNode);
        facet_steps_.resize(tool_.facets.size());
    }

    void index_vertices()
    {
        std::unordered_map<std::array<double, 3>, std::uint32_t, Vec3Hash> found;
        found.reserve(faces_.size());
        for (const CutFace& face : faces_)
        {
            std::array<std::uint32_t, 3> corners{};
            for (std::size_t i = 0; i < 3; ++i)
            {
                const Vec3& at = face.corners[i];
                const auto [entry, is_new] =
                    found.try_emplace({at.x() + 0.0, at.y() + 0.0, at.z() + 0.0},
                                      static_cast<std::uint32_t>(vertices_.size()));
                if (is_new)
                {
                    vertices_.push_back(at);
                }
                corners[i] = entry->second;
            }
            corners_.push_back(corners);
        }
        vertex_nodes_.assign(vertices_.size(), kNoNode);
    }

    void classify()
    {
        const std::size_t facets = tool_.facets.size();
        sides_.resize(vertices_.size() * facets);
        is_inside_.assign(vertices_.size(), 1);
        for (std::size_t facet = 0; facet < facets; ++facet)
        {
            const auto& [a, b, c] = tool_.facets[facet];
            const PlaneSides plane(tool_.vertices[a], tool_.vertices[b], tool_.vertices[c]);
            for (std::size_t vertex = 0; vertex < vertices_.size(); ++vertex)
            {
                const int side = plane.side_of(vertices_[vertex]);
                met_zero_ |= side == 0;
                sides_[vertex * facets + facet] = static_cast<std::int8_t>(side);
                is_inside_[vertex] &= static_cast<std::uint8_t>(side < 0);
            }
        }
        may_meet_.resize(faces_.size());
        is_gone_.resize(faces_.size());
        nodes_of_.resize(faces_.size());
        for (std::size_t face = 0; face < faces_.size(); ++face)
        {
            const auto& [a, b, c] = corners_[face];
            is_gone_[face] = is_inside_[a] != 0 && is_inside_[b] != 0 && is_inside_[c] != 0;
            const std::int8_t* of_a = &sides_[a * facets];
            const std::int8_t* of_b = &sides_[b * facets];
            const std::int8_t* of_c = &sides_[c * facets];
            bool is_apart = false;
            for (std::size_t facet = 0; facet < facets && !is_apart; ++facet)
            {
                is_apart = of_a[facet] > 0 && of_b[facet] > 0 && of_c[facet] > 0;
            }
            may_meet_[face] = !is_apart && !is_gone_[face];
        }
    }

    std::uint32_t add_node(const Vec3& at)
    {
        nodes_.push_back(at);
        return static_cast<std::uint32_t>(nodes_.size() - 1);
    }

    /// Edge of a face between two vertices, with its crossings.
    Edge& edge_between(std::uint32_t a, std::uint32_t b)
    {
        const auto [at, is_new] = edges_.try_emplace(key_of(std::min(a, b), std::max(a, b)));
        if (is_new)
        {
            at->second = crossed_edge(std::min(a, b), std::max(a, b));
        }
        return at->second;
    }

    [[nodiscard]] Edge crossed_edge(std::uint32_t low, std::uint32_t high)
    {
        Edge edge;
        const bool starts_inside = is_inside_[low] != 0;
        const bool ends_inside = is_inside_[high] != 0;
        if (starts_inside && ends_inside)
        {
            return edge;
        }
        const Vec3& from = vertices_[low];
        const Vec3& to = vertices_[high];
        const std::size_t facets = tool_.facets.size();
        const std::int8_t* low_sides = &sides_[low * facets];
        const std::int8_t* high_sides = &sides_[high * facets];
        candidates_.clear();
        double last_entry = 0.0;
        double first_exit = 1.0;
        for (std::uint32_t facet = 0; facet < facets; ++facet)
        {
            if (low_sides[facet] > 0 && high_sides[facet] > 0)
            {
                return edge;
            }
            if (low_sides[facet] == high_sides[facet])
            {
                continue;
            }
            const Vec3& corner = tool_.vertices[tool_.facets[facet][0]];
            const double start = normals_[facet].dot(from - corner);
            const double end = normals_[facet].dot(to - corner);
            const double along = std::clamp(start / (start - end), 0.0, 1.0);
            candidates_.push_back({along, facet});
            if (low_sides[facet] > 0)
            {
                last_entry = std::max(last_entry, along);
            }
            else
            {
                first_exit = std::min(first_exit, along);
            }
        }
        if (!starts_inside && !ends_inside && last_entry > first_exit + kEntryAfterExit)
        {
            return edge;
        }
        std::sort(candidates_.begin(), candidates_.end());
        const auto crosses = [&](const std::pair<double, std::uint32_t>& candidate)
        {
            const auto& [a, b, c] = tool_.facets[candidate.second];
            return common_side(
                       sides_of_edges(from, to,
                                      {tool_.vertices[a], tool_.vertices[b], tool_.vertices[c]}),
                       met_zero_) != 0;
        };
        const auto crossing = [&](const std::pair<double, std::uint32_t>& candidate) {
            return EdgeCrossing{candidate.second, add_node(from + candidate.first * (to - from))};
        };
        if (!starts_inside)
        {
            for (auto at = candidates_.rbegin(); at != candidates_.rend(); ++at)
            {
                if (low_sides[at->second] > 0 && crosses(*at))
                {
                    edge.entry = crossing(*at);
                    break;
                }
            }
        }
        if (!ends_inside && (starts_inside || edge.entry.node != kNoNode))
        {
            for (const auto& candidate : candidates_)
            {
                if (low_sides[candidate.second] < 0 && crosses(candidate))
                {
                    edge.exit = crossing(candidate);
                    break;
                }
            }
        }
        const bool has_entry = edge.entry.node != kNoNode;
        const bool has_exit = edge.exit.node != kNoNode;
        met_zero_ |= starts_inside ? !has_exit : (ends_inside ? !has_entry : has_entry != has_exit);
        return edge;
    }

    void cross_edges(std::uint32_t face)
    {
        for (std::size_t i = 0; i < 3; ++i)
        {
            edge_between(corners_[face][i], corners_[face][(i + 1) % 3]);
        }
    }

    /// Finds where the polyhedron's edges cross a face.
    void cross_face(std::uint32_t face)
    {
        const Triangle& corners = faces_[face].corners;
        const PlaneSides plane(corners[0], corners[1], corners[2]);
        tool_sides_.clear();
        for (const Vec3& vertex : tool_.vertices)
        {
            tool_sides_.push_back(plane.side_of(vertex));
        }
        for (ToolEdge& edge : tool_edges_)
        {
            const int start = tool_sides_[edge.ends[0]];
            const int end = tool_sides_[edge.ends[1]];
            if (start == end)
            {
                continue; // Also for a face without area, which no edge crosses.
            }
            met_zero_ |= start == 0 || end == 0;
            const Vec3& from = tool_.vertices[edge.ends[0]];
            const Vec3& to = tool_.vertices[edge.ends[1]];
            if (!boxes_meet(from, to, corners) ||
                common_side(sides_of_edges(from, to, corners), met_zero_) == 0)
            {
                continue;
            }
            const double along = along_of(from, to, corners);
            edge.crossings.push_back({along, start, add_node(from + along * (to - from)), face});
            const auto number = static_cast<std::uint32_t>(&edge - tool_edges_.data());
            face_crossings_.push_back(
                {face, number, static_cast<std::uint32_t>(edge.crossings.size() - 1)});
        }
    }

    [[nodiscard]] static double along_of(const Vec3& from, const Vec3& to, const Triangle& face)
    {
        const double start = volume(face[0], face[1], face[2], from);
        const double end = volume(face[0], face[1], face[2], to);
        return std::clamp(start / (start - end), 0.0, 1.0);
    }

    /// Adds the end of a segment between a face and a facet.
    void add_end(std::uint32_t facet, std::uint32_t node, bool is_start)
    {
        auto at = std::find_if(segments_.begin(), segments_.end(),
                               [&](const auto& segment) { return segment.first == facet; });
        if (at == segments_.end())
        {
            at = segments_.insert(at, {facet, {}});
        }
        std::uint32_t& end = is_start ? at->second.from : at->second.to;
        met_zero_ |= end != kNoNode;
        end = node;
    }

    /// Finds the segments in which a face meets the polyhedron's surface, and the loops around what
    /// lies outside.
    void collect_segments(std::uint32_t face)
    {
        segments_.clear();
        steps_.clear();
        for (std::size_t i = 0; i < 3; ++i)
        {
            collect_edge(corners_[face][i], corners_[face][(i + 1) % 3]);
        }
        for (;
             next_crossing_ < face_crossings_.size() && face_crossings_[next_crossing_][0] == face;
             ++next_crossing_)
        {
            const ToolEdge& edge = tool_edges_[face_crossings_[next_crossing_][1]];
            const ToolCrossing& at = edge.crossings[face_crossings_[next_crossing_][2]];
            add_end(edge.facets[0], at.node, at.sense < 0);
            add_end(edge.facets[1], at.node, at.sense > 0);
        }
        if (segments_.empty())
        {
            return;
        }
        is_gone_[face] = true;
        std::vector<std::uint32_t>& touched = nodes_of_[face];
        for (const auto& [facet, segment] : segments_)
        {
            met_zero_ |= segment.from == kNoNode || segment.to == kNoNode;
            facet_steps_[facet].push_back(segment);
            steps_.push_back(segment);
            touched.push_back(segment.from);
        }
        if (!faces_[face].is_wall && !met_zero_)
        {
            const Triangle& corners = faces_[face].corners;
            const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            fill(steps_, normal, face, false);
        }
    }

    /// The parts of a face's edge that lie outside, and the ends of segments on it.
    void collect_edge(std::uint32_t from, std::uint32_t to)
    {
        const Edge& edge = edge_between(from, to);
        const bool is_forward = from < to;
        const EdgeCrossing& entry = is_forward ? edge.entry : edge.exit;
        const EdgeCrossing& exit = is_forward ? edge.exit : edge.entry;
        if (entry.node != kNoNode)
        {
            steps_.push_back({vertex_node(from), entry.node});
            add_end(entry.facet, entry.node, true);
        }
        if (exit.node != kNoNode)
        {
            steps_.push_back({exit.node, vertex_node(to)});
            add_end(exit.facet, exit.node, false);
        }
        if (entry.node == kNoNode && exit.node == kNoNode && is_inside_[from] == 0)
        {
            steps_.push_back({vertex_node(from), vertex_node(to)});
        }
    }

    std::uint32_t vertex_node(std::uint32_t vertex)
    {
        if (vertex_nodes_[vertex] == kNoNode)
        {
            vertex_nodes_[vertex] = add_node(vertices_[vertex]);
        }
        return vertex_nodes_[vertex];
    }

    std::uint32_t tool_node(std::uint32_t vertex)
    {
        if (tool_nodes_[vertex] == kNoNode)
        {
            tool_nodes_[vertex] = add_node(tool_.vertices[vertex]);
        }
        return tool_nodes_[vertex];
    }

    void finish_faces()
    {
        for (std::uint32_t face = 0; face < faces_.size(); ++face)
        {
            if (is_gone_[face] && !faces_[face].is_wall)
            {
                result_.removed.push_back(face);
            }
        }
    }

    /// Winding number of the polyhedron's first vertex by a walk to the nearest part of the
    /// surface that was met: its front is outside. None without such a part.
    [[nodiscard]] std::optional<int> seen_winding()
    {
        std::optional<std::uint32_t> target;
        Vec3 middle(0.0, 0.0, 0.0);
        double size = -1.0;
        for (std::uint32_t face = 0; face < faces_.size(); ++face)
        {
            if (!is_gone_[face] || faces_[face].is_wall)
            {
                continue;
            }
            Vec3 sum(0.0, 0.0, 0.0);
            Vec3 low = Vec3::Constant(std::numeric_limits<double>::max());
            Vec3 high = -low;
            double count = 0.0;
            const auto add = [&](const Vec3& point)
            {
                sum += point;
                low = least_of(low, point);
                high = greatest_of(high, point);
                count += 1.0;
            };
            for (const std::uint32_t node : nodes_of_[face])
            {
                add(nodes_[node]);
            }
            for (const std::uint32_t corner : corners_[face])
            {
                if (is_inside_[corner] != 0)
                {
                    add(vertices_[corner]);
                }
            }
            if ((high - low).norm() > size)
            {
                size = (high - low).norm();
                target = face;
                middle = sum / count;
            }
        }
        if (!target)
        {
            return std::nullopt;
        }
        int sum = 0;
        const Vec3& start = tool_.vertices[0];
        for (std::uint32_t face = 0; face < faces_.size(); ++face)
        {
            if (face != *target && boxes_meet(start, middle, faces_[face].corners))
            {
                sum += crossing_of(start, middle, faces_[face].corners, met_zero_);
            }
        }
        const Triangle& corners = faces_[*target].corners;
        const int side = side_of_plane(corners[0], corners[1], corners[2], start);
        met_zero_ |= side == 0;
        return (side > 0 ? 0 : 1) - sum;
    }

    /// Winding numbers of the polyhedron's vertices, along its edges from the first vertex on.
    void set_windings(std::optional<int> first)
    {
        const int none = sense_ == CutSense::carve ? 0 : 1;
        windings_.assign(tool_.vertices.size(), first.value_or(none));
        std::vector<std::vector<std::uint32_t>> around(tool_.vertices.size());
        for (std::uint32_t i = 0; i < tool_edges_.size(); ++i)
        {
            ToolEdge& edge = tool_edges_[i];
            std::sort(edge.crossings.begin(), edge.crossings.end(),
                      [](const ToolCrossing& a, const ToolCrossing& b)
                      { return a.along < b.along || (a.along == b.along && a.node < b.node); });
            around[edge.ends[0]].push_back(i);
            around[edge.ends[1]].push_back(i);
        }
        std::vector<bool> is_known(tool_.vertices.size());
        std::vector<std::uint32_t> open{0};
        is_known[0] = true;
        while (!open.empty())
        {
            const std::uint32_t vertex = open.back();
            open.pop_back();
            for (const std::uint32_t number : around[vertex])
            {
                const ToolEdge& edge = tool_edges_[number];
                const bool is_forward = edge.ends[0] == vertex;
                const std::uint32_t other = edge.ends[is_forward ? 1 : 0];
                if (!is_known[other])
                {
                    int sum = 0;
                    for (const ToolCrossing& crossing : edge.crossings)
                    {
                        sum += crossing.sense;
                    }
                    windings_[other] = windings_[vertex] + (is_forward ? sum : -sum);
                    is_known[other] = true;
                    open.push_back(other);
                }
            }
        }
    }

    /// Adds the part of a facet's edge between two nodes, as often as the region holds it.
    void add_part(std::uint32_t from, std::uint32_t to, int winding)
    {
        const int times = sense_ == CutSense::carve ? winding : 1 - winding;
        for (int i = 0; i < std::abs(times); ++i)
        {
            steps_.push_back(times > 0 ? Step{from, to} : Step{to, from});
        }
    }

    void finish_facets()
    {
        for (std::uint32_t facet = 0; facet < tool_.facets.size(); ++facet)
        {
            steps_.clear();
            for (std::size_t i = 0; i < 3; ++i)
            {
                const ToolEdge& edge = tool_edges_[facet_edges_[3 * facet + i]];
                const bool is_forward = edge.ends[0] == tool_.facets[facet][i];
                int winding = windings_[edge.ends[0]];
                std::uint32_t last = tool_node(edge.ends[0]);
                for (std::size_t k = 0; k <= edge.crossings.size(); ++k)
                {
                    const bool is_end = k == edge.crossings.size();
                    const std::uint32_t next =
                        is_end ? tool_node(edge.ends[1]) : edge.crossings[k].node;
                    is_forward ? add_part(last, next, winding) : add_part(next, last, winding);
                    winding += is_end ? 0 : edge.crossings[k].sense;
                    last = next;
                }
            }
            for (const Step& step : facet_steps_[facet])
            {
                steps_.push_back(sense_ == CutSense::carve ? step : Step{step.to, step.from});
            }
            fill(steps_, normals_[facet], CutPiece::kFacet, sense_ == CutSense::carve);
        }
    }

    /// Fills the loops that the steps form with triangles.
    void fill(std::vector<Step>& steps, const Vec3& normal, std::uint32_t parent, bool is_turned)
    {
        Eigen::Index axis = 0;
        const double along = normal.cwiseAbs().maxCoeff(&axis);
        const bool is_mirrored = normal[axis] < 0.0;
        if (!(along > 0.0))
        {
            axis = 0;
        }
        const auto corner_of = [&](std::uint32_t node)
        {
            const GridPoint at = rounded(node);
            const auto x = static_cast<std::size_t>((axis + 1) % 3);
            const auto y = static_cast<std::size_t>((axis + 2) % 3);
            return is_mirrored ? LoopCorner{at[y], at[x], node} : LoopCorner{at[x], at[y], node};
        };
        std::vector<CornerLoop> loops = loops_of(steps, corner_of);
        for (const auto& names : triangles_of_loops(std::move(loops)))
        {
            GridTriangle corners{rounded(names[0]), rounded(names[1]), rounded(names[2])};
            if (is_turned)
            {
                std::swap(corners[1], corners[2]);
            }
            if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
            {
                result_.pieces.push_back({corners, parent});
            }
        }
    }

    [[nodiscard]] GridPoint rounded(std::uint32_t node) const
    {
        const Vec3& at = nodes_[node];
        return {static_cast<std::int32_t>(std::lround(at.x())),
                static_cast<std::int32_t>(std::lround(at.y())),
                static_cast<std::int32_t>(std::lround(at.z()))};
    }

    /// Chains steps to loops. A chain that does not return, which an open surface can leave, is
    /// closed by a straight line.
    template <typename CornerOf>
    [[nodiscard]] static std::vector<CornerLoop> loops_of(std::vector<Step>& steps,
                                                          const CornerOf& corner_of)
    {
        const auto from_lower = [](const Step& a, const Step& b)
        { return a.from < b.from || (a.from == b.from && a.to < b.to); };
        std::sort(steps.begin(), steps.end(), from_lower);
        std::vector<bool> is_used(steps.size());
        const auto unused_from = [&](std::uint32_t node)
        {
            auto at = std::lower_bound(steps.begin(), steps.end(), Step{node, 0}, from_lower);
            while (at != steps.end() && at->from == node &&
                   is_used[static_cast<std::size_t>(at - steps.begin())])
            {
                ++at;
            }
            return at != steps.end() && at->from == node
                       ? static_cast<std::size_t>(at - steps.begin())
                       : steps.size();
        };
        std::vector<CornerLoop> loops;
        const auto follow = [&](std::size_t first)
        {
            CornerLoop& loop = loops.emplace_back();
            const std::uint32_t start = steps[first].from;
            for (std::size_t at = first; at < steps.size();)
            {
                is_used[at] = true;
                loop.push_back(corner_of(steps[at].from));
                const std::uint32_t next = steps[at].to;
                at = next == start ? steps.size() : unused_from(next);
                if (next != start && at == steps.size())
                {
                    loop.push_back(corner_of(next));
                }
            }
        };
        std::vector<std::uint32_t> ends;
        for (const Step& step : steps)
        {
            ends.push_back(step.to);
        }
        std::sort(ends.begin(), ends.end());
        for (std::size_t i = 0; i < steps.size(); ++i)
        {
            if (!is_used[i] && !std::binary_search(ends.begin(), ends.end(), steps[i].from))
            {
                follow(i);
            }
        }
        for (std::size_t i = 0; i < steps.size(); ++i)
        {
            if (!is_used[i])
            {
                follow(i);
            }
        }
        return loops;
    }

    std::span<const CutFace> faces_;
    const Polyhedron& tool_;
    CutSense sense_;
    bool met_zero_{false};

    std::vector<Vec3> normals_; ///< Normals of facets, not of unit length.
    std::vector<ToolEdge> tool_edges_;
    std::vector<std::uint32_t> facet_edges_; ///< Three for each facet, in the order of its corners.
    std::vector<std::uint32_t> tool_nodes_;  ///< One entry a vertex of the polyhedron.
    std::vector<std::vector<Step>> facet_steps_;
    std::vector<int> windings_; ///< One entry a vertex of the polyhedron.

    std::vector<Vec3> vertices_; ///< Vertices of the surface, each position once.
    std::vector<std::array<std::uint32_t, 3>>
        corners_;                             ///< Corners of faces, as indices of vertices_.
    std::vector<std::int8_t> sides_;          ///< Sorted by vertex, then by facet.
    std::vector<std::uint8_t> is_inside_;     ///< One entry a vertex.
    std::vector<std::uint32_t> vertex_nodes_; ///< One entry a vertex.
    std::vector<bool> may_meet_;              ///< One entry a face.
    std::vector<bool> is_gone_;               ///< One entry a face.
    std::vector<std::vector<std::uint32_t>> nodes_of_; ///< Nodes on the polyhedron, by face.
    std::unordered_map<std::uint64_t, Edge> edges_;
    /// Face, edge of the polyhedron, and place among the edge's crossings; ascending by face.
    std::vector<std::array<std::uint32_t, 3>> face_crossings_;
    std::size_t next_crossing_{0};

    std::vector<Vec3> nodes_;
    SurfaceCut result_;

    // Scratch.
    std::vector<std::pair<double, std::uint32_t>> candidates_;
    std::vector<int> tool_sides_;
    std::vector<std::pair<std::uint32_t, Step>> segments_;
    std::vector<Step> steps_;
};

} // namespace

std::optional<int> crossings(const Vec3& from, const Vec3& to, std::span<const CutFace> faces)
{
    int sum = 0;
    bool met_zero = false;
    for (const CutFace& face : faces)
    {
        sum += crossing_of(from, to, face.corners, met_zero);
    }
    return met_zero ? std::nullopt : std::optional(sum);
}

std::optional<SurfaceCut> cut_surface(std::span<const CutFace> faces, const Polyhedron& tool,
                                      CutSense sense, std::optional<int> winding)
{
    return Cutter(faces, tool, sense).run(winding);
}

} // namespace tactus
