// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/collapse_mesh.hpp"

#include "rt_core/base/assert.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace tactus
{

namespace
{

constexpr std::uint32_t kNoFace = Collapse::kNoFace;

constexpr std::uint32_t next_corner(std::uint32_t corner) noexcept
{
    return corner == 2 ? 0 : corner + 1;
}

constexpr std::uint32_t previous_corner(std::uint32_t corner) noexcept
{
    return corner == 0 ? 2 : corner - 1;
}

} // namespace

Star star_at(const VertexRing& ring, std::uint32_t place) noexcept
{
    const std::uint32_t count = ring.face_count;
    Star star{ring.vertex, ring.parent_at(place), 0, {kNoFace, kNoFace}, {}};
    const bool last_of_border = ring.open && place == 1;
    const bool first_of_border = ring.open && place == 0;
    if (!last_of_border)
    {
        star.faces[0] = ring.faces[place];
    }
    if (!first_of_border)
    {
        star.faces[1] = ring.faces[last_of_border ? count - 1 : (place + count - 1) % count];
    }
    const std::uint32_t fan_start = last_of_border ? 0 : place + 1;
    star.fan_size = count - (ring.open ? 1U : 2U);
    for (std::uint32_t i = 0; i < star.fan_size; ++i)
    {
        star.faces[2 + i] = ring.faces[(fan_start + i) % count];
        star.rim[i] = ring.neighbours[(fan_start + i) % count];
    }
    star.rim[star.fan_size] = ring.neighbours[ring.open ? fan_start + star.fan_size
                                                        : (fan_start + star.fan_size) % count];
    return star;
}

Result<CollapseMesh, Refusal> CollapseMesh::create(const QuantisedMesh& mesh)
{
    auto neighbours = match_edges(mesh);
    if (!neighbours)
    {
        return neighbours.error();
    }
    CollapseMesh result(mesh, std::move(neighbours).value());
    for (std::uint32_t v = 0; v < result.vertex_count(); ++v)
    {
        if (result.degree_[v] == 0)
        {
            return Refusal{"vertex " + std::to_string(v) + " belongs to no face"};
        }
        if (result.walk_degree(v) != result.degree_[v])
        {
            return Refusal{"the faces of vertex " + std::to_string(v) + " form more than one fan"};
        }
    }
    return result;
}

CollapseMesh::CollapseMesh(const QuantisedMesh& mesh, FaceNeighbours neighbours)
    : corners_(mesh.faces)
    , neighbours_(std::move(neighbours))
    , first_face_(mesh.positions.size(), kNoFace)
    , degree_(mesh.positions.size(), 0)
    , faces_left_(static_cast<std::uint32_t>(mesh.faces.size()))
    , vertices_left_(static_cast<std::uint32_t>(mesh.positions.size()))
{
    find_first_faces();
}

void CollapseMesh::find_first_faces() noexcept
{
    for (std::uint32_t f = 0; f < corners_.size(); ++f)
    {
        for (std::uint32_t corner = 0; corner < 3; ++corner)
        {
            const std::uint32_t v = corners_[f][corner];
            ++degree_[v];
            if (first_face_[v] == kNoFace || neighbours_[f][corner] == kNoFace)
            {
                first_face_[v] = f;
            }
        }
    }
}

bool CollapseMesh::is_closed() const
{
    for (std::uint32_t f = 0; f < corners_.size(); ++f)
    {
        const auto& across = neighbours_[f];
        if (!is_removed_face(f) && std::find(across.begin(), across.end(), kNoFace) != across.end())
        {
            return false;
        }
    }
    return true;
}

std::vector<std::uint32_t> CollapseMesh::present_faces() const
{
    std::vector<std::uint32_t> present;
    present.reserve(faces_left_);
    for (std::uint32_t face = 0; face < corners_.size(); ++face)
    {
        if (!is_removed_face(face))
        {
            present.push_back(face);
        }
    }
    return present;
}

std::uint32_t CollapseMesh::corner_of(std::uint32_t face, std::uint32_t vertex) const noexcept
{
    const auto& corners = corners_[face];
    return corners[0] == vertex ? 0 : (corners[1] == vertex ? 1 : 2);
}

/// The face after `face`, counter-clockwise around the vertex; kNoFace at a border.
std::uint32_t CollapseMesh::next_round(std::uint32_t vertex, std::uint32_t face) const noexcept
{
    return neighbours_[face][previous_corner(corner_of(face, vertex))];
}

std::uint32_t CollapseMesh::walk_degree(std::uint32_t vertex) const noexcept
{
    std::uint32_t count = 0;
    std::uint32_t face = first_face_[vertex];
    do
    {
        ++count;
        face = next_round(vertex, face);
    } while (face != kNoFace && face != first_face_[vertex]);
    return count;
}

void CollapseMesh::walk_ring(std::uint32_t vertex, VertexRing& ring) const noexcept
{
    std::uint32_t face = first_face_[vertex];
    ring.vertex = vertex;
    ring.face_count = degree_[vertex];
    ring.open = neighbours_[face][corner_of(face, vertex)] == kNoFace;
    TACTUS_ASSERT(ring.face_count <= kMaxStarFaces);
    for (std::uint32_t i = 0; i < ring.face_count; ++i)
    {
        const std::uint32_t corner = corner_of(face, vertex);
        ring.faces[i] = face;
        ring.neighbours[i] = corners_[face][next_corner(corner)];
        ring.neighbours[i + 1] = corners_[face][previous_corner(corner)];
        face = neighbours_[face][previous_corner(corner)];
    }
}

bool CollapseMesh::gather_ring(std::uint32_t vertex, VertexRing& ring) const noexcept
{
    const std::uint32_t degree = degree_[vertex];
    if (degree == 0 || degree > kMaxStarFaces)
    {
        return false;
    }
    walk_ring(vertex, ring);
    const std::uint32_t removed = ring.open ? 1 : 2;
    return degree > removed && degree - removed <= kMaxFanFaces;
}

bool CollapseMesh::has_neighbour(std::uint32_t vertex,
                                 std::span<const std::uint32_t> among) const noexcept
{
    const auto is_among = [&](std::uint32_t other)
    { return std::find(among.begin(), among.end(), other) != among.end(); };
    std::uint32_t face = first_face_[vertex];
    do
    {
        const std::uint32_t corner = corner_of(face, vertex);
        const std::uint32_t next = neighbours_[face][previous_corner(corner)];
        // The next face repeats the previous corner as its next corner; only the last face at a
        // border has no next face.
        if (is_among(corners_[face][next_corner(corner)]) ||
            (next == kNoFace && is_among(corners_[face][previous_corner(corner)])))
        {
            return true;
        }
        face = next;
    } while (face != kNoFace && face != first_face_[vertex]);
    return false;
}

/// True if the parent is a neighbour of a rim vertex. Walks around the rim if the parent has more
/// faces than the rim's vertices together can have.
bool CollapseMesh::joins_rim(const Star& star, std::span<const std::uint32_t> rim) const noexcept
{
    if (degree_[star.parent] <= kMaxDegree)
    {
        return has_neighbour(star.parent, rim);
    }
    return std::any_of(rim.begin(), rim.end(),
                       [&](std::uint32_t w) {
                           return has_neighbour(w, std::span{&star.parent, 1});
                       });
}

/// The star on a border has one face of A and B, and its ring ends at a vertex c:
///
///       w0--u              the hole (v, c, u) has three edges if the border goes on from u to c
///         \ | \  G           in a face G. With v on u, the last fan face and G share u-c.
///   A, fan  v--c
///
std::uint32_t CollapseMesh::face_across_hole(const Star& star) const noexcept
{
    if (star.has_face(0) == star.has_face(1))
    {
        return kNoFace;
    }
    const std::uint32_t end = star.open_end();
    const std::uint32_t from = star.has_face(0) ? star.parent : end;
    const std::uint32_t to = star.has_face(0) ? end : star.parent;
    // First face of the fan: its edge from `from` is a border.
    const std::uint32_t face = first_face_[from];
    const bool is_three = corners_[face][next_corner(corner_of(face, from))] == to;
    // With fewer than three faces, the new inner vertex would have two faces back to back.
    const bool is_round = degree_[end] >= 3 && degree_[star.parent] + star.fan_size >= 4;
    return is_three && is_round ? face : kNoFace;
}

bool CollapseMesh::is_legal(const Star& star) const noexcept
{
    const std::uint32_t removed = (star.has_face(0) ? 1U : 0U) + (star.has_face(1) ? 1U : 0U);
    const std::uint32_t before = degree_[star.parent];
    if (before + star.fan_size > std::max(kMaxDegree, before) + removed)
    {
        return false;
    }
    const bool closes_hole = face_across_hole(star) != kNoFace;
    const std::uint32_t first = star.has_face(0) || closes_hole ? 1 : 0;
    const std::uint32_t end = star.fan_size + (star.has_face(1) || closes_hole ? 0 : 1);
    if (joins_rim(star, std::span{star.rim}.subspan(first, end - first)))
    {
        return false;
    }
    if (removed == 2 && star.fan_size == 1)
    {
        const std::uint32_t a = star.faces[0];
        const std::uint32_t beyond = neighbours_[a][corner_of(a, star.parent)];
        return beyond == kNoFace || corners_[beyond][corner_of(beyond, star.rim[1])] != star.rim[1];
    }
    return true;
}

/// Unlinks A (or B), the face `removed`, and joins the fan's end face to the face beyond it:
///
///     A = (v, u, w0), beyond it the face with edge w0 -> u; the fan's first face has edge v -> w0.
///     B = (v, wk, u), beyond it the face with edge u -> wk; the fan's last face has edge wk -> v.
void CollapseMesh::bypass(std::uint32_t removed, std::uint32_t vertex, const Star& star,
                          bool side_a) noexcept
{
    const std::uint32_t rim = side_a ? star.rim[0] : star.rim[star.fan_size];
    const std::uint32_t fan = side_a ? star.faces[2] : star.faces[1 + star.fan_size];
    const std::uint32_t beyond =
        neighbours_[removed][corner_of(removed, side_a ? star.parent : rim)];
    neighbours_[fan][corner_of(fan, side_a ? vertex : rim)] = beyond;
    if (beyond != kNoFace)
    {
        neighbours_[beyond][corner_of(beyond, side_a ? rim : star.parent)] = fan;
    }
    if (first_face_[rim] == removed)
    {
        first_face_[rim] = fan;
    }
    if (first_face_[star.parent] == removed)
    {
        first_face_[star.parent] = star.faces[2];
    }
    --degree_[rim];
    --degree_[star.parent];
    --faces_left_;
}

void CollapseMesh::collapse(const Star& star) noexcept
{
    TACTUS_ASSERT(star.fan_size >= 1 && star.fan_size <= kMaxFanFaces);
    if (const std::uint32_t across = face_across_hole(star); across != kNoFace)
    {
        const std::uint32_t end = star.open_end();
        const std::uint32_t fan = star.faces[star.has_face(0) ? 1 + star.fan_size : 2];
        neighbours_[fan][corner_of(fan, star.has_face(0) ? end : star.vertex)] = across;
        neighbours_[across][corner_of(across, star.has_face(0) ? star.parent : end)] = fan;
    }
    for (const std::uint32_t side : {0U, 1U})
    {
        if (star.has_face(side))
        {
            bypass(star.faces[side], star.vertex, star, side == 0);
            corners_[star.faces[side]].fill(kNoFace);
        }
    }
    for (std::uint32_t i = 0; i < star.fan_size; ++i)
    {
        const std::uint32_t face = star.faces[2 + i];
        corners_[face][corner_of(face, star.vertex)] = star.parent;
    }
    degree_[star.parent] += star.fan_size;
    degree_[star.vertex] = 0;
    --vertices_left_;
}

void CollapseMesh::absorb(const Star& star) noexcept
{
    for (const std::uint32_t side : {0U, 1U})
    {
        if (!star.has_face(side))
        {
            continue;
        }
        for (const std::uint32_t corner : corners_[star.faces[side]])
        {
            vertices_left_ -= degree_[corner] != 0 && corner != star.parent ? 1U : 0U;
            degree_[corner] = corner == star.parent ? degree_[corner] : 0;
        }
        corners_[star.faces[side]].fill(kNoFace);
        --faces_left_;
    }
    for (std::uint32_t i = 0; i < star.fan_size; ++i)
    {
        const std::uint32_t face = star.faces[2 + i];
        corners_[face][corner_of(face, star.vertex)] = star.parent;
    }
    first_face_[star.parent] = first_face_[star.vertex];
    degree_[star.parent] = degree_[star.vertex];
    degree_[star.vertex] = 0;
    --vertices_left_;
}

} // namespace tactus
