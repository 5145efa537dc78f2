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

// Any thread, except the haptic one: calls allocate, and work on their arguments alone.
namespace tactus
{

/// Allowed range of the diagonal of a model's box.
inline constexpr double kMinDiagonal_m = 1e-6;
inline constexpr double kMaxDiagonal_m = 1e6;

/// Metres per unit for a unit's name, in either case of letters: mm, cm, m, in, inch. None for
/// other names.
[[nodiscard]] std::optional<double> metres_per_unit(std::string_view unit);

struct PrepareOptions
{
    double metres_per_unit{1.0}; ///< Metres per unit of the source; positive and finite.
    std::optional<double>
        fit_diagonal_m{}; ///< Diagonal to which the model is scaled, independent of its unit.
    /// Bits of a coordinate, kMinPositionBits .. kMaxPositionBits.
    unsigned position_bits{kMinPositionBits};
    /// Allows more bits if a coarser grid would change the mesh's shape.
    bool adds_bits{false};
    /// Joins border vertices up to half a step apart. A border vertex on a border edge of another
    /// face becomes a corner of that face, so that the grid cannot separate them.
    bool stitches{false};
    /// A point of the grid, in metres, in the source's frame. Models with the same place share
    /// their grid if their steps are equal. [default: the least corner of the box]
    std::optional<std::array<double, 3>> grid_place_m{};
    /// Maximum step of the grid; a mesh that would need more than kMaxPositionBits keeps a larger
    /// step.
    std::optional<double> quantum_max_m{};
    /// Vertices of neighbouring meshes, in metres, in the source's frame. Border edges on which
    /// they lie are stitched to them.
    std::vector<std::array<double, 3>> beside_m{};
    /// Greatest distance that the caller has already moved vertices, in metres; a lower limit of
    /// the rounding in quantisation_m.
    double moved_m{0.0};
    bool keeps_winding{false}; ///< Keeps the orientation of closed pieces that are inside out.
    /// Moves the middle of the box to the origin, together with the grid.
    bool is_centered{false};
};

/// A mesh on the integer grid, and the grid's place in the model's frame, which is the source's
/// frame scaled and moved: origin_m + quantum_m x integer.
struct PreparedMesh
{
    QuantisedMesh mesh;
    double quantum_m{0.0};                    ///< Step of the grid; a power of two.
    unsigned position_bits{kMinPositionBits}; ///< Bits of a coordinate.
    /// Position of the integer point (0, 0, 0) in the model's frame: the least corner of the
    /// source's box, or the nearest point of the grid through grid_place_m.
    std::array<double, 3> origin_m{};
    double quantisation_m{0.0}; ///< Largest distance between a source vertex and its grid position.
    double diagonal_m{0.0};     ///< Diagonal of the source's box, scaled, not rounded.
    double metres_per_unit{0.0}; ///< Scale, from the unit or the requested diagonal.

    /// Vertices dropped because an earlier one has the same position.
    std::size_t welded_vertices{0};
    std::size_t isolated_vertices{0}; ///< Vertices dropped because no face uses them.
    std::size_t degenerate_faces{0};  ///< Faces dropped because two corners coincide.
    /// Faces dropped because an earlier one has the same corners in the same order.
    std::size_t duplicate_faces{0};
    /// Edges opened because they did not have two faces in opposite directions.
    std::size_t cut_edges{0};
    /// Copies of vertices: one for each fan of a vertex except its first.
    std::size_t added_vertices{0};
    /// Border vertices that were moved to another vertex's position.
    std::size_t joined_vertices{0};
    std::size_t stitched_faces{0}; ///< Faces added by stitching.
    std::size_t flat_faces{0};     ///< Faces kept though their corners are collinear on the grid.
    std::size_t turned_pieces{0};  ///< Closed pieces that were inside out.
    std::size_t turned_voids{0};   ///< Voids, i.e. closed pieces in others, that faced outwards.
    /// Notes, one line each: a translation, added bits, and each count above that is not zero.
    std::vector<std::string> notes;
};

/// Scales the mesh, welds equal positions, drops degenerate and duplicate items, and rounds
/// positions to the grid. Cuts the mesh into 2-manifold pieces and reverses closed pieces of wrong
/// orientation; a closed piece inside another is a void. The same input gives the same result on
/// every machine; vertices and faces keep their order, copies of vertices come last. The opposite
/// of a face is kept: the two are a two-sided sheet and are separated. Nearly linear in the mesh: 4
/// M faces take 2.5 s and, with the source, 80 B a face at the peak. Refused, with name and place:
/// an option out of range, an invalid index or coordinate, a diagonal out of range, and a mesh
/// without remaining faces.
[[nodiscard]] Result<PreparedMesh, Refusal> prepare_mesh(const TriangleMesh& source,
                                                         const PrepareOptions& options);

/// Step of the grid that prepare_mesh() chooses, at the cost of its first part. Has the same
/// refusals.
[[nodiscard]] Result<double, Refusal> grid_step(const TriangleMesh& source,
                                                const PrepareOptions& options);

} // namespace tactus
