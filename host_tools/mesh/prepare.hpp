// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/quantised_mesh.hpp"
#include "host_tools/mesh/triangle_mesh.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/limits.hpp"
#include "transport/base/refusal.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Any thread, but not the haptic one: calls allocate, and work on their arguments alone.
namespace tactus
{

/// The bounding-box diagonals that a model may have.
inline constexpr double kMinDiagonal_m = 1e-6;
inline constexpr double kMaxDiagonal_m = 1e6;

/// Metres per unit for the unit names that a user may give, in capitals or not: mm, cm, m, in,
/// inch. None for other names.
[[nodiscard]] std::optional<double> metres_per_unit(std::string_view unit);

struct PrepareOptions
{
    double metres_per_unit{1.0}; ///< Of the source; positive and finite.
    std::optional<double>
        fit_diagonal_m{}; ///< Scales the model to this diagonal, whatever its unit.
    unsigned position_bits{kMinPositionBits}; ///< kMinPositionBits .. kMaxPositionBits.
    /// Takes more bits than these where a coarser grid would change the mesh's shape.
    bool adds_bits{false};
    /// Makes one of border vertices that are a small part of a step apart, and corners of border
    /// vertices that lie on another border edge, so that the grid can't part what meets there.
    bool stitches{false};
    /// A place of the grid, in metres of the source's frame; without one the box's least corner.
    /// Models with the same one share their grid where their steps are equal.
    std::optional<std::array<double, 3>> grid_place_m{};
    /// No larger step than this, as far as kMaxPositionBits allow.
    std::optional<double> quantum_max_m{};
    /// Vertices of meshes beside this one, in metres of the source's frame: where they lie on its
    /// border edges, these are stitched to them, too.
    std::vector<std::array<double, 3>> beside_m{};
    double moved_m{0.0}; ///< How far vertices were moved before, at most; a part of quantisation_m.
    bool keeps_winding{false}; ///< Closed pieces that are inside out stay so.
    /// The middle of the box becomes the origin; the grid moves along.
    bool is_centered{false};
};

/// A mesh on the integer grid and where the grid lies in the model's frame, which is the source's,
/// scaled and moved: origin_m + quantum_m x integer.
struct PreparedMesh
{
    QuantisedMesh mesh;
    double quantum_m{0.0};                    ///< A power of two.
    unsigned position_bits{kMinPositionBits}; ///< That coordinates have room in.
    /// Least corner of the source's box, in the model's frame, or the place of the grid nearest it.
    std::array<double, 3> origin_m{};
    double quantisation_m{0.0};  ///< Largest distance between a source vertex and its place.
    double diagonal_m{0.0};      ///< The diagonal of the source's box, scaled, not rounded.
    double metres_per_unit{0.0}; ///< The scale: by the unit, or to fit the diagonal.

    std::size_t welded_vertices{0};   ///< Dropped for an equal position before them.
    std::size_t isolated_vertices{0}; ///< Dropped since no face uses them.
    std::size_t degenerate_faces{0};  ///< Dropped: two corners in one place.
    std::size_t duplicate_faces{0};   ///< Dropped: the same corners in the same order before.
    std::size_t cut_edges{0};         ///< Opened: not two faces in opposite directions.
    std::size_t added_vertices{0};    ///< Copies that give each fan a vertex of its own.
    std::size_t joined_vertices{0};   ///< Border vertices that took the place of another one.
    std::size_t stitched_faces{0};    ///< Added by stitching.
    std::size_t flat_faces{0};        ///< Kept, though their corners lie on one line of the grid.
    std::size_t turned_pieces{0};     ///< Closed pieces that were inside out.
    std::size_t turned_voids{0};      ///< Closed pieces in others that had to face inwards.
    std::vector<std::string> notes;   ///< One line for each of these that is not zero.
};

/// Scales, welds equal positions, drops what is degenerate or there twice, puts the mesh on the
/// grid, cuts it into 2-manifold pieces and turns closed ones that look the wrong way (a closed
/// piece within another one is a void). The same input gives the same result on every machine;
/// vertices and faces keep their order, copies of vertices come last. A face's opposite is kept:
/// together they are a two-sided sheet and part into two.
/// Nearly linear in the mesh: 4 M faces take 2.5 s and, with the source, 80 B a face at the peak.
/// Refused, by name and place: an option out of range, an index or coordinate that is none, a
/// diagonal out of range, and a mesh of which no face is left.
[[nodiscard]] Result<PreparedMesh, Refusal> prepare_mesh(const TriangleMesh& source,
                                                         const PrepareOptions& options);

/// The step of the grid that prepare_mesh() chooses, at the cost of its first part. Refuses what
/// that does.
[[nodiscard]] Result<double, Refusal> grid_step(const TriangleMesh& source,
                                                const PrepareOptions& options);

} // namespace tactus
