// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/simplify.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus
{

/// Face across the edge from corner i to corner i + 1 of each face; Collapse::kNoFace on a border.
using FaceNeighbours = std::vector<std::array<std::uint32_t, 3>>;

/// Finds the faces that share an edge. Refuses, naming the face or edge: no faces or too many,
/// an index out of range, a vertex repeated in a face, a position off the grid, an edge with three
/// faces or with two that run along it in the same direction. Costs a sort of each vertex's edges.
[[nodiscard]] Result<FaceNeighbours, Refusal> match_edges(const QuantisedMesh& mesh);

/// Maximum number of faces of a vertex after a collapse, unless it had more before. The limit keeps
/// stars within kMaxStarFaces and costs no quality.
inline constexpr std::uint32_t kMaxDegree = 10;

/// The faces around one vertex, counter-clockwise. Face i is (vertex, neighbours[i], neighbours[i +
/// 1]); if the ring is closed, neighbours[face_count] repeats neighbours[0].
struct VertexRing
{
    std::uint32_t vertex{0};
    std::uint32_t face_count{0};
    /// True if the vertex is on a border, and with it the first and last neighbour.
    bool open{false};
    std::array<std::uint32_t, kMaxStarFaces> faces{};
    std::array<std::uint32_t, kMaxStarFaces + 1> neighbours{};

    /// Number of possible collapses of the vertex; places are 0 .. count - 1.
    [[nodiscard]] std::uint32_t place_count() const noexcept { return open ? 2 : face_count; }
    /// The neighbour onto which the vertex collapses at a place; on a border only its two border
    /// neighbours.
    [[nodiscard]] std::uint32_t parent_at(std::uint32_t place) const noexcept
    {
        return neighbours[open && place == 1 ? face_count : place];
    }
};

/// A possible collapse of `vertex` onto `parent`, in the canonical order of rt_core/spm/page.hpp.
struct Star
{
    std::uint32_t vertex{0};
    std::uint32_t parent{0};
    std::uint32_t fan_size{0};
    std::array<std::uint32_t, kMaxStarFaces> faces{};  ///< Faces A, B (or kNoFace), then the fan.
    std::array<std::uint32_t, kMaxFanFaces + 1> rim{}; ///< Vertices w0 .. wk, k = fan_size.

    [[nodiscard]] bool has_face(std::uint32_t side) const noexcept
    {
        return faces[side] != Collapse::kNoFace;
    }
    /// Border vertex at the fan's end without A or B; the star must have exactly one of these two
    /// faces.
    [[nodiscard]] std::uint32_t open_end() const noexcept
    {
        return rim[has_face(0) ? fan_size : 0];
    }
};

/// Star of the collapse of the ring's vertex onto parent_at(place).
[[nodiscard]] Star star_at(const VertexRing& ring, std::uint32_t place) noexcept;

/// The mesh during simplification: corners, the face across each edge, and each vertex's first face
/// and degree. 26 bytes a face. Faces and vertices keep their numbers; removed ones stay in place.
///
/// Only collapses that keep the mesh 2-manifold with borders are legal. The link condition requires
/// that the ends of the edge have no common neighbour except the one or two across the edge. A
/// border counts as joined to a vertex at infinity, so a border vertex moves along its border only.
/// A vertex with three faces is not removed if its fourth face exists already: a tetrahedron stays.
/// A hole of three edges counts as a face that is removed with the edge, so it closes.
class CollapseMesh
{
public:
    /// Creates the mesh. Refusals name the place: those of match_edges(), a vertex without faces,
    /// and a vertex with more than one fan.
    [[nodiscard]] static Result<CollapseMesh, Refusal> create(const QuantisedMesh& mesh);

    [[nodiscard]] std::uint32_t vertex_count() const noexcept
    {
        return static_cast<std::uint32_t>(degree_.size());
    }
    [[nodiscard]] std::uint32_t faces_left() const noexcept { return faces_left_; }
    [[nodiscard]] std::uint32_t vertices_left() const noexcept { return vertices_left_; }
    [[nodiscard]] std::uint32_t face_count() const noexcept
    {
        return static_cast<std::uint32_t>(corners_.size());
    }
    [[nodiscard]] std::uint32_t degree(std::uint32_t vertex) const noexcept
    {
        return degree_[vertex];
    }
    [[nodiscard]] bool is_removed(std::uint32_t vertex) const noexcept
    {
        return degree_[vertex] == 0;
    }
    [[nodiscard]] bool is_removed_face(std::uint32_t face) const noexcept
    {
        return corners_[face][0] == Collapse::kNoFace;
    }
    [[nodiscard]] const std::array<std::uint32_t, 3>& corners(std::uint32_t face) const noexcept
    {
        return corners_[face];
    }
    /// True if no present face has a border edge.
    [[nodiscard]] bool is_closed() const;
    /// Faces that are not removed, ascending.
    [[nodiscard]] std::vector<std::uint32_t> present_faces() const;
    [[nodiscard]] std::uint32_t neighbour(std::uint32_t face, std::uint32_t edge) const noexcept
    {
        return neighbours_[face][edge];
    }

    /// Fills the ring of a present vertex with at most kMaxStarFaces faces.
    void walk_ring(std::uint32_t vertex, VertexRing& ring) const noexcept;

    /// Fills `ring`. Returns false if the vertex is removed or the fan of its stars is empty or
    /// exceeds kMaxFanFaces.
    [[nodiscard]] bool gather_ring(std::uint32_t vertex, VertexRing& ring) const noexcept;

    /// Face that will share an edge with the fan's open end if the collapse closes a hole of three
    /// edges; otherwise kNoFace.
    [[nodiscard]] std::uint32_t face_across_hole(const Star& star) const noexcept;

    /// True if the collapse keeps the mesh manifold and the parent's degree within kMaxDegree. The
    /// cost is a walk around the parent, or around the rim's vertices if the parent's degree is
    /// above kMaxDegree.
    [[nodiscard]] bool is_legal(const Star& star) const noexcept;

    /// Replaces the vertex by the parent in the fan and removes A and B. `star` must be legal.
    void collapse(const Star& star) noexcept;

    /// Executes all steps of an Absorption except the flattening; `star` is its last step. Removes
    /// A and B and their corners except the parent, which replaces the vertex in the fan.
    void absorb(const Star& star) noexcept;

private:
    CollapseMesh(const QuantisedMesh& mesh, FaceNeighbours neighbours);

    [[nodiscard]] std::uint32_t corner_of(std::uint32_t face, std::uint32_t vertex) const noexcept;
    [[nodiscard]] std::uint32_t next_round(std::uint32_t vertex, std::uint32_t face) const noexcept;
    [[nodiscard]] std::uint32_t walk_degree(std::uint32_t vertex) const noexcept;
    [[nodiscard]] bool has_neighbour(std::uint32_t vertex,
                                     std::span<const std::uint32_t> among) const noexcept;
    [[nodiscard]] bool joins_rim(const Star& star,
                                 std::span<const std::uint32_t> rim) const noexcept;
    void find_first_faces() noexcept;
    void bypass(std::uint32_t removed, std::uint32_t vertex, const Star& star,
                bool side_a) noexcept;

    std::vector<std::array<std::uint32_t, 3>> corners_;
    FaceNeighbours neighbours_;
    /// One face of each vertex; on a border the first of the fan, so that a counter-clockwise walk
    /// visits all faces.
    std::vector<std::uint32_t> first_face_;
    std::vector<std::uint32_t> degree_; ///< Number of faces of the vertex; 0 if removed.
    std::uint32_t faces_left_{0};
    std::uint32_t vertices_left_{0};
};

} // namespace tactus
