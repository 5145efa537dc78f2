// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/collapse_mesh.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace tactus
{

namespace
{

/// Maximum number of faces. Usual meshes have half as many records, and record ids end at
/// kMaxRecords.
constexpr std::size_t kMaxFaces = std::size_t{kMaxRecords};
constexpr std::int32_t kGridEnd = 1 << kMaxPositionBits;

/// An edge of a face, listed at its lower-numbered vertex; `far_vertex` is the other end and
/// `corner` the corner of the face where the edge starts.
struct EdgeEnd
{
    std::uint32_t far_vertex;
    std::uint32_t face;
    std::uint8_t corner;
    bool outward; ///< True if the face runs from the lower-numbered vertex to the higher.

    auto operator<=>(const EdgeEnd&) const noexcept = default;
};

std::string text_of(std::size_t number)
{
    return std::to_string(number);
}

std::optional<Refusal> find_bad_face(const QuantisedMesh& mesh)
{
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    {
        const auto& corners = mesh.faces[f];
        for (const std::uint32_t vertex : corners)
        {
            if (vertex >= mesh.positions.size())
            {
                return Refusal{"face " + text_of(f) + " names vertex " + text_of(vertex) +
                               ", but the mesh has " + text_of(mesh.positions.size()) +
                               " vertices"};
            }
        }
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
        {
            return Refusal{"face " + text_of(f) +
                           " names a vertex twice; its three corners must differ"};
        }
    }
    return std::nullopt;
}

std::optional<Refusal> find_bad_mesh(const QuantisedMesh& mesh)
{
    if (mesh.faces.empty() || mesh.faces.size() > kMaxFaces)
    {
        return Refusal{"the mesh has " + text_of(mesh.faces.size()) + " faces; allowed are 1 to " +
                       text_of(kMaxFaces)};
    }
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    {
        const auto off_grid = [](std::int32_t value) { return value < 0 || value >= kGridEnd; };
        if (std::ranges::any_of(mesh.positions[v], off_grid))
        {
            return Refusal{"vertex " + text_of(v) + " is off the grid; coordinates are 0 to " +
                           text_of(kGridEnd - 1)};
        }
    }
    return find_bad_face(mesh);
}

/// All edge ends, grouped by lower-numbered vertex: group v is [start[v], start[v + 1]).
struct EdgeGroups
{
    std::vector<std::uint64_t> start;
    std::vector<EdgeEnd> ends;
};

template <typename Visit>
void for_each_directed_edge(const QuantisedMesh& mesh, const Visit& visit)
{
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
    {
        for (std::uint8_t corner = 0; corner < 3; ++corner)
        {
            visit(f, corner, mesh.faces[f][corner], mesh.faces[f][(corner + 1U) % 3U]);
        }
    }
}

EdgeGroups group_edges(const QuantisedMesh& mesh)
{
    EdgeGroups groups;
    groups.start.resize(mesh.positions.size() + 2, 0);
    groups.ends.resize(3 * mesh.faces.size());
    for_each_directed_edge(mesh, [&](std::uint32_t, std::uint8_t, std::uint32_t from,
                                     std::uint32_t to) { ++groups.start[std::min(from, to) + 2]; });
    for (std::size_t v = 2; v < groups.start.size(); ++v)
    {
        groups.start[v] += groups.start[v - 1];
    }
    // While the groups are filled, start[v + 1] is the next free index of group v; afterwards it is
    // the end of group v.
    for_each_directed_edge(
        mesh,
        [&](std::uint32_t f, std::uint8_t corner, std::uint32_t from, std::uint32_t to)
        {
            groups.ends[groups.start[std::min(from, to) + 1]++] =
                EdgeEnd{std::max(from, to), f, corner, from < to};
        });
    return groups;
}

std::optional<Refusal> join_faces(std::uint32_t vertex, std::span<EdgeEnd> group,
                                  FaceNeighbours& neighbours)
{
    std::ranges::sort(group);
    for (std::size_t i = 1; i < group.size(); ++i)
    {
        const EdgeEnd& first = group[i - 1];
        const EdgeEnd& second = group[i];
        if (first.far_vertex != second.far_vertex)
        {
            continue;
        }
        const std::string edge =
            "the edge between vertices " + text_of(vertex) + " and " + text_of(first.far_vertex);
        if (i + 1 < group.size() && group[i + 1].far_vertex == first.far_vertex)
        {
            return Refusal{edge + " has more than two faces: " + text_of(first.face) + ", " +
                           text_of(second.face) + " and " + text_of(group[i + 1].face)};
        }
        if (first.outward == second.outward)
        {
            return Refusal{"faces " + text_of(first.face) + " and " + text_of(second.face) +
                           " run along " + edge + " in the same direction"};
        }
        neighbours[first.face][first.corner] = second.face;
        neighbours[second.face][second.corner] = first.face;
    }
    return std::nullopt;
}

} // namespace

Result<FaceNeighbours, Refusal> match_edges(const QuantisedMesh& mesh)
{
    if (auto bad = find_bad_mesh(mesh))
    {
        return std::move(*bad);
    }
    EdgeGroups groups = group_edges(mesh);
    constexpr std::uint32_t kNone = Collapse::kNoFace;
    FaceNeighbours neighbours(mesh.faces.size(), {kNone, kNone, kNone});
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
    {
        const std::size_t begin = groups.start[v];
        const std::size_t count = groups.start[v + 1] - begin;
        if (auto bad = join_faces(v, std::span{groups.ends}.subspan(begin, count), neighbours))
        {
            return std::move(*bad);
        }
    }
    return neighbours;
}

} // namespace tactus
