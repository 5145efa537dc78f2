// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/collapse_mesh.hpp"
#include "host_tools/simplify/fragment_pool.hpp"
#include "host_tools/simplify/index_map.hpp"
#include "host_tools/simplify/piece_settler.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "host_tools/simplify/surface_samples.hpp"
#include "host_tools/simplify/triangle_cut.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus
{

/// Proven bound of the distance between each face and the original surface.
///
/// Every point of the original surface is assigned to exactly one present face, in pieces: whole
/// original triangles or fragments of them. A collapse takes all pieces of its star and assigns
/// each to one face of the new fan. A face is a convex set, so the distance to it is a convex
/// function and a piece's largest distance is at a corner: e(face) = max over its pieces of max
/// over corners. The faces to which a point is assigned in turn depend only on the collapses of
/// stars that contained the point. The bound of a face state therefore holds in every
/// dependency-closed cut that has the face in this state.
///
/// The assignment of pieces to faces, and their cuts, affect only the tightness:
///   1. a triangle whose fragments are all in the star becomes whole again;
///   2. its corners' distances to the new faces are measured once per vertex;
///   3. no assignment does better than the lower bound, the largest distance of a measured point
///      to its nearest face; a piece goes to its best face uncut if that is nearly as good;
///   4. otherwise it is cut along the new edges and each part goes to its best face.
///
/// Cut points are rounded (see TrianglePoint), so parts leave gaps; each cut adds the width of its
/// gap to the bound of its parts.
class Certificate
{
public:
    Certificate(const QuantisedMesh& mesh, unsigned workers);

    /// Bound in quanta: 0 while the face is original, above 0 afterwards.
    [[nodiscard]] float error(std::uint32_t face) const noexcept { return errors_[face]; }

    /// Assigns the pieces of a star to the faces that its collapse leaves. Stars without a common
    /// face may be processed in any order or concurrently, each worker with its own number.
    void reassign(const Star& star, unsigned worker);

    /// Selects samples evenly among the pieces of the surface assigned to the face. No other worker
    /// may re-assign the face during the call.
    [[nodiscard]] FaceSamples sample(std::uint32_t face, unsigned worker);

private:
    /// Working memory of one re-assignment, kept per worker for reuse.
    struct Scratch
    {
        std::vector<std::uint32_t> triangles;
        std::vector<std::uint32_t> fragments;
        std::vector<Part> parts; ///< Parts of the triangles, then of the fragments.
        std::vector<std::uint32_t> counts;
        IndexMap map;
        PieceSettler settler;
        std::array<double, kMaxFanFaces> bound{};
    };

    void collect_pieces(std::span<const std::uint32_t> faces, std::vector<std::uint32_t>& triangles,
                        std::vector<std::uint32_t>& fragments) const;
    void take_pieces(const Star& star, Scratch& scratch);
    void merge_back(Scratch& scratch, unsigned worker);
    void place_corners(Scratch& scratch) const;
    void give_triangle(std::uint32_t triangle, const Part& part, const Star& star, unsigned worker);
    void give_fragment(std::uint32_t fragment, const Part& part, const Star& star, unsigned worker);
    void add_fragment(std::uint32_t fragment, std::uint32_t triangle, const Assignment& given,
                      const Star& star, Scratch& scratch);
    [[nodiscard]] SurfacePoint middle_of(std::uint32_t triangle,
                                         const std::array<TrianglePoint, 3>& corners,
                                         double weight) const;

    const QuantisedMesh& mesh_;
    double diagonal_{0};
    std::vector<float> errors_; ///< Bound by face.
    /// First whole triangle assigned to each face, or kNone.
    std::vector<std::uint32_t> first_whole_;
    std::vector<std::uint32_t> next_whole_; ///< Next whole triangle of the same face, by triangle.
    std::vector<std::uint32_t> first_fragment_; ///< First fragment assigned to each face, or kNone.
    std::vector<std::uint32_t> fragment_count_; ///< Number of fragments by triangle; 0 if whole.
    FragmentPool pool_;
    std::vector<Scratch> scratch_;
};

} // namespace tactus
