// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/absorption.hpp"

#include "host_tools/mesh/mesh_places.hpp"
#include "host_tools/simplify/parallel_blocks.hpp"
#include "host_tools/simplify/vertex_search.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <optional>
#include <tuple>

namespace tactus
{

namespace
{

constexpr std::uint32_t kAbsent = Collapse::kNoFace;
/// Maximum number of places kept for each component: another absorption may use the nearest one.
constexpr std::size_t kPlacesMax = 4;
constexpr std::size_t kPartBlock = 256;
/// Weight of the tip in the cost of a place, see place_at(). If it were larger, flat plates would
/// be coarse before small parts on them vanish; if smaller, a distant small part would early leave
/// a spike.
constexpr double kTipWeight = 1e-3;

/// A component that cannot shrink: one face, two faces back to back, or a tetrahedron.
struct StuckPart
{
    StaticVector<std::uint32_t, 4> faces;
    StaticVector<std::uint32_t, 4> vertices;

    [[nodiscard]] bool has(std::uint32_t vertex) const noexcept
    {
        return std::find(vertices.begin(), vertices.end(), vertex) != vertices.end();
    }
};

/// Possible absorption of a part: x is moved onto d, see Absorption.
struct Place
{
    double cost{0};
    std::size_t part{0};
    std::uint32_t x{0}; ///< Vertex of the other component.
    std::uint32_t d{0}; ///< Vertex of the part.
};

/// Total order of places, cheapest first.
bool is_before(const Place& a, const Place& b) noexcept
{
    return std::tie(a.cost, a.part, a.x, a.d) < std::tie(b.cost, b.part, b.x, b.d);
}

/// Stuck part whose lowest face is `face`; none if the component can shrink.
std::optional<StuckPart> stuck_part_of(const CollapseMesh& current, std::uint32_t face)
{
    StuckPart part;
    part.faces.push_back(face);
    for (std::uint32_t edge = 0; edge < 3; ++edge)
    {
        const std::uint32_t other = current.neighbour(face, edge);
        const bool is_known =
            std::find(part.faces.begin(), part.faces.end(), other) != part.faces.end();
        if (other != kAbsent && other < face)
        {
            return std::nullopt;
        }
        if (other != kAbsent && !is_known)
        {
            part.faces.push_back(other);
        }
    }
    const auto is_mine = [&](std::uint32_t other)
    { return std::find(part.faces.begin(), part.faces.end(), other) != part.faces.end(); };
    for (const std::uint32_t mine : part.faces)
    {
        for (std::uint32_t edge = 0; edge < 3; ++edge)
        {
            const std::uint32_t other = current.neighbour(mine, edge);
            // A single triangle has three borders; two faces and a tetrahedron have none.
            if (part.faces.size() == 1 ? other != kAbsent : !is_mine(other))
            {
                return std::nullopt;
            }
        }
        for (const std::uint32_t corner : current.corners(mine))
        {
            if (!part.has(corner) && !part.vertices.try_push_back(corner))
            {
                return std::nullopt;
            }
        }
    }
    const bool is_common =
        part.faces.size() != 3 && part.vertices.size() == (part.faces.size() == 4 ? 4U : 3U);
    return is_common ? std::optional(part) : std::nullopt;
}

std::vector<StuckPart> find_stuck_parts(const CollapseMesh& current)
{
    std::vector<StuckPart> parts;
    for (const std::uint32_t face : current.present_faces())
    {
        if (const auto part = stuck_part_of(current, face))
        {
            parts.push_back(*part);
        }
    }
    return parts;
}

double squared_length(const QuantisedMesh& mesh, std::uint32_t a, std::uint32_t b)
{
    return (grid_point(mesh, a) - grid_point(mesh, b)).squaredNorm();
}

double area_of(const QuantisedMesh& mesh, const CollapseMesh& current, const StuckPart& part)
{
    double area = 0;
    for (const std::uint32_t face : part.faces)
    {
        const auto& [a, b, c] = current.corners(face);
        const Vec3 origin = grid_point(mesh, a);
        area += 0.5 * (grid_point(mesh, b) - origin).cross(grid_point(mesh, c) - origin).norm();
    }
    return area;
}

/// Place at which d's part can be absorbed by x. None if x is a vertex of the part, or on a border
/// while the part has more than one face. The cost is area times squared distance, as for a
/// candidate, plus a term for the tip that d forms in x's ring.
std::optional<Place> place_at(const QuantisedMesh& mesh, const CollapseMesh& current,
                              const StuckPart& part, std::uint32_t x, std::uint32_t d)
{
    VertexRing ring;
    current.walk_ring(x, ring);
    if (part.has(x) || (part.faces.size() > 1 && ring.open))
    {
        return std::nullopt;
    }
    const double squared = squared_length(mesh, x, d);
    return Place{squared * (area_of(mesh, current, part) + kTipWeight * squared), 0, x, d};
}

using PartPlaces = StaticVector<Place, kPlacesMax>;

/// The cheapest places of a part, at most kPlacesMax, cheapest first.
PartPlaces places_of(const QuantisedMesh& mesh, const CollapseMesh& current,
                     const VertexSearch& search, const std::vector<StuckPart>& parts,
                     std::size_t part)
{
    std::vector<Place> found;
    for (const std::uint32_t d : parts[part].vertices)
    {
        for (const std::uint32_t x : search.nearest(d))
        {
            if (auto place = place_at(mesh, current, parts[part], x, d))
            {
                place->part = part;
                found.push_back(*place);
            }
        }
    }
    std::ranges::sort(found, is_before);
    PartPlaces places;
    for (std::size_t i = 0; i < std::min(found.size(), kPlacesMax); ++i)
    {
        places.push_back(found[i]);
    }
    return places;
}

std::vector<Place> find_places(const QuantisedMesh& mesh, const CollapseMesh& current,
                               const std::vector<StuckPart>& parts, unsigned threads)
{
    std::vector<std::uint32_t> takers;
    for (std::uint32_t v = 0; v < current.vertex_count(); ++v)
    {
        if (!current.is_removed(v) && current.degree(v) <= kMaxFanFaces)
        {
            takers.push_back(v);
        }
    }
    const VertexSearch search(mesh, takers);
    std::vector<PartPlaces> by_part(parts.size());
    parallel_blocks(threads, parts.size(), kPartBlock,
                    [&](unsigned, std::size_t begin, std::size_t end)
                    {
                        for (std::size_t part = begin; part < end; ++part)
                        {
                            by_part[part] = places_of(mesh, current, search, parts, part);
                        }
                    });
    std::vector<Place> places;
    for (const PartPlaces& part : by_part)
    {
        places.insert(places.end(), part.begin(), part.end());
    }
    std::ranges::sort(places, is_before);
    return places;
}

/// Index of y in the ring of x: the neighbour nearest to s. On a border only index 0 gives a
/// manifold edge.
std::uint32_t place_of_y(const QuantisedMesh& mesh, const VertexRing& ring, std::uint32_t s)
{
    std::uint32_t best = 0;
    for (std::uint32_t i = 1; !ring.open && i < ring.face_count; ++i)
    {
        if (squared_length(mesh, ring.neighbours[i], s) <
            squared_length(mesh, ring.neighbours[best], s))
        {
            best = i;
        }
    }
    return best;
}

/// First step for a tetrahedron: the vertex farthest from x, except d, collapses onto d.
Star flatten(const QuantisedMesh& mesh, const CollapseMesh& current, const StuckPart& part,
             const Place& place)
{
    std::uint32_t farthest = place.d;
    for (const std::uint32_t v : part.vertices)
    {
        const bool is_farther =
            squared_length(mesh, v, place.x) > squared_length(mesh, farthest, place.x);
        farthest = v != place.d && (farthest == place.d || is_farther) ? v : farthest;
    }
    VertexRing ring;
    current.walk_ring(farthest, ring);
    std::uint32_t at = 0;
    while (ring.parent_at(at) != place.d)
    {
        ++at;
    }
    return star_at(ring, at);
}

Absorption make_absorption(const QuantisedMesh& mesh, const CollapseMesh& current,
                           const StuckPart& part, const Place& place)
{
    Absorption absorption;
    std::array<std::uint32_t, 2> sides{part.faces[0], kAbsent}; // Faces (d, s, t) and (d, t, s).
    std::array<std::uint32_t, 3> corners = current.corners(part.faces[0]);
    if (part.faces.size() == 2)
    {
        sides[1] = part.faces[1];
    }
    else if (part.faces.size() == 4)
    {
        const Star flattening = flatten(mesh, current, part, place);
        sides[0] = flattening.faces[2];
        sides[1] =
            *std::find_if(part.faces.begin(), part.faces.end(),
                          [&](std::uint32_t face)
                          {
                              const auto& c = current.corners(face);
                              return std::find(c.begin(), c.end(), flattening.vertex) == c.end();
                          });
        corners = {flattening.parent, flattening.rim[0], flattening.rim[1]};
        absorption.steps.push_back(flattening);
    }
    std::rotate(corners.begin(), std::ranges::find(corners, place.d), corners.end());
    const auto [d, s, t] = corners;
    VertexRing ring;
    current.walk_ring(place.x, ring);
    const std::uint32_t first = place_of_y(mesh, ring, s);
    const std::uint32_t y = ring.neighbours[first];
    const std::uint32_t count = sides[1] == kAbsent ? 1 : 2;
    absorption.steps.push_back(
        {t, place.x, count, {kAbsent, kAbsent, sides[0], sides[1]}, {d, s, d}});
    absorption.steps.push_back(
        {s, y, count, {kAbsent, kAbsent, sides[0], sides[1]}, {place.x, d, place.x}});
    Star last{place.x, d, ring.face_count, {sides[0], sides[1]}, {}};
    for (std::uint32_t i = 0; i < ring.face_count; ++i)
    {
        const std::uint32_t from = (first + i) % ring.face_count;
        last.faces[2 + i] = ring.faces[from];
        last.rim[i] = ring.neighbours[from];
        last.rim[i + 1] = ring.neighbours[from + 1];
    }
    absorption.steps.push_back(last);
    return absorption;
}

} // namespace

AbsorptionPlan plan_absorptions(const QuantisedMesh& mesh, const CollapseMesh& current,
                                std::size_t faces_wanted, double cost_max, unsigned threads)
{
    const std::vector<StuckPart> parts = find_stuck_parts(current);
    AbsorptionPlan plan;
    std::vector<std::uint8_t> is_taken(mesh.faces.size(), 0);
    std::size_t removed = 0;
    for (const Place& place : find_places(mesh, current, parts, threads))
    {
        if (removed >= faces_wanted || place.cost > cost_max)
        {
            plan.cost_left = place.cost;
            break;
        }
        StaticVector<std::uint32_t, 4 + kMaxFanFaces> faces;
        for (const std::uint32_t face : parts[place.part].faces)
        {
            faces.push_back(face);
        }
        VertexRing ring;
        current.walk_ring(place.x, ring);
        for (std::uint32_t i = 0; i < ring.face_count; ++i)
        {
            faces.push_back(ring.faces[i]);
        }
        if (std::any_of(faces.begin(), faces.end(), [&](auto face) { return is_taken[face] != 0; }))
        {
            continue;
        }
        std::for_each(faces.begin(), faces.end(), [&](auto face) { is_taken[face] = 1; });
        removed += parts[place.part].faces.size();
        plan.absorptions.push_back(make_absorption(mesh, current, parts[place.part], place));
    }
    return plan;
}

std::size_t count_stuck_faces(const CollapseMesh& current)
{
    std::size_t count = 0;
    for (const StuckPart& part : find_stuck_parts(current))
    {
        count += part.faces.size();
    }
    return count;
}

std::size_t count_components(const CollapseMesh& current)
{
    std::vector<std::uint8_t> is_reached(current.face_count(), 0);
    std::vector<std::uint32_t> open;
    std::size_t count = 0;
    for (const std::uint32_t seed : current.present_faces())
    {
        if (is_reached[seed] != 0)
        {
            continue;
        }
        ++count;
        is_reached[seed] = 1;
        open.push_back(seed);
        while (!open.empty())
        {
            const std::uint32_t face = open.back();
            open.pop_back();
            for (std::uint32_t edge = 0; edge < 3; ++edge)
            {
                const std::uint32_t other = current.neighbour(face, edge);
                if (other != kAbsent && is_reached[other] == 0)
                {
                    is_reached[other] = 1;
                    open.push_back(other);
                }
            }
        }
    }
    return count;
}

} // namespace tactus
