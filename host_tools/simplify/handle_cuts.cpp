// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/handle_cuts.hpp"

#include "host_tools/mesh/index_lists.hpp"
#include "host_tools/mesh/mesh_places.hpp"
#include "host_tools/simplify/collapse_mesh.hpp"
#include "rt_core/base/assert.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace tactus
{

namespace
{

using Face = std::array<std::uint32_t, 3>;

constexpr std::uint32_t kBorder = Collapse::kNoFace;
/// Maximum number of faces visited on each side of a ring. Sides that have not met by then count as
/// connected: a ring that separates such large pieces costs only a few vertices.
constexpr std::size_t kSideFacesMax = 4'096;
/// Maximum number of edges at which the search for a ring starts; the shortest ring is taken.
constexpr std::size_t kBeginningsMax = 8;

std::uint32_t corner_of(const Face& face, std::uint32_t vertex)
{
    return face[0] == vertex ? 0 : (face[1] == vertex ? 1 : 2);
}

bool has(const Face& face, std::uint32_t vertex)
{
    return face[corner_of(face, vertex)] == vertex;
}

/// Second ends of the pairs, listed by first end; first ends are below `numbers`.
IndexLists second_ends(std::size_t numbers, std::span<const MeshEdge> pairs)
{
    return {numbers, [pairs](const auto& add)
            {
                for (const auto& [first, second] : pairs)
                {
                    add(first, second);
                }
            }};
}

/// Edges of the faces in both directions, sorted, each once.
std::vector<MeshEdge> edges_of(std::span<const Face> faces)
{
    std::vector<MeshEdge> edges;
    edges.reserve(6 * faces.size());
    for (const auto& [a, b, c] : faces)
    {
        for (const MeshEdge& edge : {MeshEdge{a, b}, MeshEdge{b, c}, MeshEdge{c, a}})
        {
            edges.push_back(edge);
            edges.push_back({edge[1], edge[0]});
        }
    }
    std::ranges::sort(edges);
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

/// Three vertices that are connected in pairs.
struct Triple
{
    double length{0}; ///< Sum of its squared sides, in quanta^2.
    Face at{};        ///< Vertices, ascending.

    [[nodiscard]] std::array<MeshEdge, 3> edges() const
    {
        return {MeshEdge{at[0], at[1]}, MeshEdge{at[1], at[2]}, MeshEdge{at[2], at[0]}};
    }
    friend bool operator<(const Triple& a, const Triple& b)
    {
        return std::tie(a.length, a.at) < std::tie(b.length, b.at);
    }
};

/// The base mesh with its own vertex numbers, and the cuts made so far.
class CutBase
{
public:
    CutBase(const QuantisedMesh& mesh, const Simplification& coarse)
    {
        for (const Face& corners : coarse.base_corners)
        {
            source_.insert(source_.end(), corners.begin(), corners.end());
        }
        std::ranges::sort(source_);
        source_.erase(std::unique(source_.begin(), source_.end()), source_.end());
        for (const std::uint32_t vertex : source_)
        {
            mesh_.positions.push_back(mesh.positions[vertex]);
        }
        for (const Face& corners : coarse.base_corners)
        {
            Face& face = mesh_.faces.emplace_back();
            std::ranges::transform(corners, face.begin(),
                                   [&](std::uint32_t vertex)
                                   {
                                       const auto at = std::ranges::lower_bound(source_, vertex);
                                       return static_cast<std::uint32_t>(at - source_.begin());
                                   });
        }
        auto across = match_edges(mesh_);
        TACTUS_ASSERT(across.has_value());
        across_ = std::move(across).value();
        side_of_.assign(mesh_.faces.size(), 0);
        for (std::uint32_t f = 0; f < mesh_.faces.size(); ++f)
        {
            for (std::uint32_t i = 0; i < 3; ++i)
            {
                sides_.push_back({{mesh_.faces[f][i], mesh_.faces[f][(i + 1) % 3]}, 3 * f + i});
            }
        }
        std::ranges::sort(sides_);
    }

    [[nodiscard]] std::size_t vertex_count() const { return source_.size(); }
    /// Vertex of the source mesh, by vertex of the base mesh.
    [[nodiscard]] std::uint32_t source(std::uint32_t vertex) const { return source_[vertex]; }

    /// Triples of inner edges that form no face, shortest first.
    [[nodiscard]] std::vector<Triple> find_triples() const
    {
        const IndexLists neighbours = second_ends(vertex_count(), edges_of(mesh_.faces));
        std::vector<Triple> triples;
        for (const auto& [edge, half] : sides_)
        {
            const auto [a, b] = edge;
            const std::uint32_t other = a < b ? across_[half / 3][half % 3] : kBorder;
            if (other == kBorder)
            {
                continue;
            }
            for (const std::uint32_t c : neighbours.of(b))
            {
                const bool is_face = has(mesh_.faces[half / 3], c) || has(mesh_.faces[other], c);
                if (c > b && !is_face && std::ranges::binary_search(neighbours.of(a), c) &&
                    is_inner({b, c}) && is_inner({c, a}))
                {
                    triples.push_back({squared(a, b) + squared(b, c) + squared(c, a), {a, b, c}});
                }
            }
        }
        std::sort(triples.begin(), triples.end());
        return triples;
    }

    /// Cuts along the triple, unless that separates the mesh.
    [[nodiscard]] bool try_cut(const Triple& triple)
    {
        std::vector<std::uint32_t> left;
        std::vector<std::uint32_t> right;
        for (const auto& [from, to] : triple.edges())
        {
            left.push_back(half_edge({from, to}) / 3);
            right.push_back(half_edge({to, from}) / 3);
        }
        part(triple);
        if (are_one(std::move(left), std::move(right)))
        {
            return true;
        }
        join(triple);
        return false;
    }

    /// Reverts the cut along a triple.
    void join(const Triple& triple)
    {
        for (const auto& [from, to] : triple.edges())
        {
            const std::uint32_t left = half_edge({from, to});
            const std::uint32_t right = half_edge({to, from});
            across_[left / 3][left % 3] = right / 3;
            across_[right / 3][right % 3] = left / 3;
        }
    }

private:
    void part(const Triple& triple)
    {
        for (const auto& [from, to] : triple.edges())
        {
            for (const std::uint32_t half : {half_edge({from, to}), half_edge({to, from})})
            {
                across_[half / 3][half % 3] = kBorder;
            }
        }
    }

    [[nodiscard]] double squared(std::uint32_t a, std::uint32_t b) const
    {
        return (grid_point(mesh_, a) - grid_point(mesh_, b)).squaredNorm();
    }
    /// Half-edge of a directed edge, which must exist: 3 x face + index of the first corner.
    [[nodiscard]] std::uint32_t half_edge(const MeshEdge& edge) const
    {
        return std::ranges::lower_bound(sides_, std::pair(edge, 0U))->second;
    }
    [[nodiscard]] bool is_inner(const MeshEdge& edge) const
    {
        const auto is_there = [&](const MeshEdge& way)
        {
            const auto at = std::ranges::lower_bound(sides_, std::pair(way, 0U));
            return at != sides_.end() && at->first == way;
        };
        return is_there(edge) && is_there({edge[1], edge[0]});
    }

    /// True if a path of faces connects the left faces with the right ones, or if kSideFacesMax
    /// faces a side do not decide it. Searches from both sides in turn.
    [[nodiscard]] bool are_one(std::vector<std::uint32_t> left, std::vector<std::uint32_t> right)
    {
        last_side_ += 2;
        const std::array sides{last_side_, last_side_ + 1};
        std::array<std::vector<std::uint32_t>, 2> reached{std::move(left), std::move(right)};
        for (std::size_t side = 0; side < 2; ++side)
        {
            for (const std::uint32_t face : reached[side])
            {
                side_of_[face] = sides[side];
            }
        }
        for (std::size_t at = 0; at < kSideFacesMax; ++at)
        {
            for (std::size_t side = 0; side < 2; ++side)
            {
                if (at == reached[side].size())
                {
                    return false;
                }
                for (const std::uint32_t next : across_[reached[side][at]])
                {
                    if (next == kBorder || side_of_[next] == sides[side])
                    {
                        continue;
                    }
                    if (side_of_[next] == sides[1 - side])
                    {
                        return true;
                    }
                    side_of_[next] = sides[side];
                    reached[side].push_back(next);
                }
            }
        }
        return true;
    }

    std::vector<std::uint32_t> source_;
    QuantisedMesh mesh_;
    FaceNeighbours across_;
    /// Directed edges with their half-edges, sorted.
    std::vector<std::pair<MeshEdge, std::uint32_t>> sides_;
    std::vector<std::uint32_t> side_of_; ///< Side of each face in the last search.
    std::uint32_t last_side_{0};
};

/// Rings in the source through the patches of three base vertices.
class RingSearch
{
public:
    RingSearch(const QuantisedMesh& mesh, const Simplification& coarse)
        : base_of_(mesh.positions.size())
        , neighbours_(second_ends(mesh.positions.size(), edges_of(mesh.faces)))
        , members_(second_ends(mesh.positions.size(), members_of(coarse)))
        , before_(mesh.positions.size(), kBorder)
    {
    }

    /// Finds a ring through the patches of three base vertices in turn; empty if no path was found.
    /// A patch is the set of source vertices that moved onto one base vertex.
    [[nodiscard]] std::vector<MeshEdge> find(const Face& patches)
    {
        std::vector<MeshEdge> beginnings;
        for (const std::uint32_t first : members_.of(patches[0]))
        {
            for (const std::uint32_t last : neighbours_.of(first))
            {
                if (base_of_[last] == patches[2])
                {
                    beginnings.push_back({first, last});
                }
            }
        }
        const std::size_t step = (beginnings.size() + kBeginningsMax - 1) / kBeginningsMax;
        std::vector<MeshEdge> best;
        for (std::size_t i = 0; i < beginnings.size(); i += step)
        {
            std::vector<MeshEdge> ring = shortest(beginnings[i], patches);
            if (!ring.empty() && (best.empty() || ring.size() < best.size()))
            {
                best = std::move(ring);
            }
        }
        return best;
    }

private:
    /// Pairs of a base vertex and a vertex that has moved onto it; fills base_of_.
    std::vector<MeshEdge> members_of(const Simplification& coarse)
    {
        std::iota(base_of_.begin(), base_of_.end(), 0U);
        for (std::size_t i = coarse.collapses.size(); i-- > 0;)
        {
            base_of_[coarse.collapses[i].vertex] = base_of_[coarse.collapses[i].parent];
        }
        std::vector<MeshEdge> pairs;
        for (std::uint32_t v = 0; v < base_of_.size(); ++v)
        {
            pairs.push_back({base_of_[v], v});
        }
        return pairs;
    }

    /// Closes a shortest path from the first end of `beginning` to its last end by that edge. The
    /// path passes the patches in order; empty if there is none.
    [[nodiscard]] std::vector<MeshEdge> shortest(const MeshEdge& beginning, const Face& patches)
    {
        const auto [first, last] = beginning;
        std::vector<std::uint32_t> reached{first};
        before_[first] = first;
        for (std::size_t at = 0; at < reached.size() && before_[last] == kBorder; ++at)
        {
            const std::uint32_t here = reached[at];
            const std::uint32_t patch = corner_of(patches, base_of_[here]);
            for (const std::uint32_t next : neighbours_.of(here))
            {
                const bool goes_on = base_of_[next] == patches[patch] ||
                                     (patch < 2 && base_of_[next] == patches[patch + 1]);
                if (goes_on && before_[next] == kBorder)
                {
                    before_[next] = here;
                    reached.push_back(next);
                }
            }
        }
        std::vector<MeshEdge> ring;
        if (before_[last] != kBorder)
        {
            ring.push_back({last, first});
            for (std::uint32_t v = last; v != first; v = before_[v])
            {
                ring.push_back({before_[v], v});
            }
        }
        for (const std::uint32_t vertex : reached)
        {
            before_[vertex] = kBorder;
        }
        return ring;
    }

    std::vector<std::uint32_t> base_of_; ///< Base vertex onto which each vertex of the mesh moved.
    IndexLists neighbours_;
    IndexLists members_;                ///< Vertices that moved onto each base vertex.
    std::vector<std::uint32_t> before_; ///< Previous vertex on the path, in a search.
};

/// Faces across each face's edges; none across an edge that is cut.
FaceNeighbours neighbours_in_cut(const QuantisedMesh& mesh, std::span<const MeshEdge> edges)
{
    auto matched = match_edges(mesh);
    TACTUS_ASSERT(matched.has_value());
    FaceNeighbours across = std::move(matched).value();
    std::vector<MeshEdge> cut;
    for (const auto& [a, b] : edges)
    {
        cut.push_back({std::min(a, b), std::max(a, b)});
    }
    std::ranges::sort(cut);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    {
        for (std::size_t i = 0; i < 3; ++i)
        {
            const auto [a, b] = std::minmax(mesh.faces[f][i], mesh.faces[f][(i + 1) % 3]);
            if (std::ranges::binary_search(cut, MeshEdge{a, b}))
            {
                across[f][i] = kBorder;
            }
        }
    }
    return across;
}

} // namespace

std::vector<std::vector<MeshEdge>> find_handle_rings(const QuantisedMesh& mesh,
                                                     const Simplification& coarse)
{
    CutBase base(mesh, coarse);
    RingSearch search(mesh, coarse);
    std::vector<bool> is_taken(base.vertex_count(), false);
    std::vector<std::vector<MeshEdge>> rings;
    for (const Triple& triple : base.find_triples())
    {
        const auto [a, b, c] = triple.at;
        if (is_taken[a] || is_taken[b] || is_taken[c] || !base.try_cut(triple))
        {
            continue;
        }
        auto ring = search.find({base.source(a), base.source(b), base.source(c)});
        if (ring.empty())
        {
            base.join(triple);
            continue;
        }
        is_taken[a] = is_taken[b] = is_taken[c] = true;
        rings.push_back(std::move(ring));
    }
    return rings;
}

std::size_t cut_open(QuantisedMesh& mesh, std::span<const MeshEdge> edges)
{
    const FaceNeighbours across = neighbours_in_cut(mesh, edges);
    const std::vector<Face> before = mesh.faces;
    const std::size_t vertices = mesh.positions.size();
    std::vector<bool> is_on_cut(vertices, false);
    for (const auto& [a, b] : edges)
    {
        is_on_cut[a] = is_on_cut[b] = true;
    }
    std::vector<bool> is_used(vertices, false);
    std::vector<bool> is_named(3 * before.size(), false);
    const auto name_fan = [&](std::uint32_t start, std::uint32_t old, std::uint32_t name)
    {
        // Walks clockwise to the fan's end or once around, then counter-clockwise from the start.
        for (const std::uint32_t turn : {2U, 0U})
        {
            std::uint32_t face = start;
            while (face != kBorder)
            {
                const std::uint32_t corner = corner_of(before[face], old);
                if (is_named[3 * face + corner] && face != start)
                {
                    break;
                }
                is_named[3 * face + corner] = true;
                mesh.faces[face][corner] = name;
                face = across[face][(corner + turn) % 3];
                if (face == start)
                {
                    break;
                }
            }
        }
    };
    for (std::uint32_t f = 0; f < before.size(); ++f)
    {
        for (std::uint32_t corner = 0; corner < 3; ++corner)
        {
            const std::uint32_t vertex = before[f][corner];
            if (!is_on_cut[vertex] || is_named[3 * f + corner])
            {
                continue;
            }
            const auto copy = static_cast<std::uint32_t>(mesh.positions.size());
            if (is_used[vertex])
            {
                mesh.positions.push_back(std::array(mesh.positions[vertex]));
            }
            name_fan(f, vertex, is_used[vertex] ? copy : vertex);
            is_used[vertex] = true;
        }
    }
    return mesh.positions.size() - vertices;
}

} // namespace tactus
