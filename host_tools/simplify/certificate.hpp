// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/collapse_mesh.hpp"
#include "host_tools/simplify/fragment_pool.hpp"
#include "host_tools/simplify/point_triangle.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "host_tools/simplify/surface_samples.hpp"
#include "host_tools/simplify/triangle_cut.hpp"
#include "rt_core/base/static_vector.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus
{

/// A part of an original triangle and the fan face that it is assigned to.
struct Assignment
{
    Part part;
    std::uint32_t place{0}; ///< Index of that face in the fan.
    double squared{0};      ///< Largest squared distance of a corner to that face.
};

/// Assigns the pieces of one star to its new faces and cuts them. No assignment does better than
/// the lower bound, the largest distance of a measured point to its nearest face. A piece whose
/// best face is nearly as good stays uncut; any other is cut along the new edges. Memory is reused
/// from star to star.
class PieceSettler
{
public:
    /// Starts a star: prepares the fan faces after the collapse. Between each two adjacent ones
    /// lies a cut plane: a half plane from the parent along their common edge that bisects the
    /// angle of their normals.
    void begin(const QuantisedMesh& mesh, const Star& star);

    /// Adds a corner of a piece; returns its index for Part::points.
    std::uint32_t add_point(const Vec3& point);

    /// Measures the corners added since begin() and computes the distance up to which a piece stays
    /// uncut, at least `floor_quanta`.
    void measure(double floor_quanta);

    /// Assigns a piece: returns its parts with their faces, or the piece itself if it stays uncut.
    /// The result is valid until the next call.
    [[nodiscard]] std::span<const Assignment> settle(const Part& piece, const QuantisedMesh& mesh,
                                                     std::uint32_t triangle);

private:
    void measure_new_points();
    [[nodiscard]] Assignment assign_to_best(const Part& part) const noexcept;
    void cut_open_parts(const CutPlane& plane, const TriangleFrame& frame);

    std::uint32_t fan_size_{0};
    std::array<DistanceTriangle, kMaxFanFaces> faces_;
    StaticVector<CutPlane, kMaxFanFaces> planes_;
    PointColumns points_;
    /// Squared distances of each face, by point.
    std::array<std::vector<double>, kMaxFanFaces> squared_;
    double accepted_{0}; ///< Squared distance up to which a piece stays uncut.
    std::vector<Assignment> settled_;
    std::vector<Assignment> open_; ///< Parts that the next plane may cut.
    std::vector<Assignment> next_open_;
};

/// Numbers distinct 32-bit keys 0, 1, 2 ... in the order of first occurrence. Scratch memory that
/// is cleared for each star: open addressing, at most half full, memory kept between uses.
class IndexMap
{
public:
    /// Removes all keys and makes room for `keys_max` distinct keys.
    void reset(std::size_t keys_max)
    {
        size_ = 0;
        mask_ = std::bit_ceil(2 * keys_max + 2) - 1;
        if (slots_.size() <= mask_)
        {
            slots_.resize(mask_ + 1);
        }
        std::fill_n(slots_.begin(), mask_ + 1, Slot{0, kEmpty});
    }

    /// Number of the key; a new key gets the value of `size()` before the call.
    std::uint32_t index_of(std::uint32_t key)
    {
        std::size_t at = (key * 0x9E37'79B1ULL >> 7U) & mask_;
        while (slots_[at].index != kEmpty && slots_[at].key != key)
        {
            at = (at + 1) & mask_;
        }
        if (slots_[at].index == kEmpty)
        {
            slots_[at] = {key, size_++};
        }
        return slots_[at].index;
    }

    [[nodiscard]] std::uint32_t size() const noexcept { return size_; }

private:
    static constexpr std::uint32_t kEmpty = 0xFFFF'FFFFU;

    struct Slot
    {
        std::uint32_t key;
        std::uint32_t index;
    };

    std::vector<Slot> slots_;
    std::size_t mask_{0};
    std::uint32_t size_{0};
};

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
