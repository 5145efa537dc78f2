// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/geometry/shared_features.hpp"
#include "rt_core/query/face_pair_queue.hpp"
#include "rt_core/query/mesh_findings.hpp"
#include "rt_core/records/contact.hpp"

#include <array>
#include <cstdint>

namespace tactus
{

class AbTree;
struct BlockGeometry;
struct PlacedBlock;

/// Decides intersection and distance of near face pairs, and reports them to MeshFindings: in
/// single precision with proven bounds first, and exactly for open cases that matter. Haptic
/// thread. Valid for one query.
class FaceDecision // NOLINT(cppcoreguidelines-pro-type-member-init): distances_ are written first.
{
public:
    FaceDecision(const MeshQuestion& question, MeshFindings& findings,
                 MeshMemory& memory) noexcept TACTUS_NONBLOCKING;

    /// Adds a pair of faces that may matter; `is_open` if one of them is coarse and above the
    /// tolerance. The other arguments are those of FacePairQueue::add().
    void add(const FacePair& pair, bool is_open, const PlacedBlock& tool,
             const BlockGeometry& block, const VertexRows& rows,
             float slack) noexcept TACTUS_NONBLOCKING;
    /// Bounds the distance by the remembered faces, before all others; this leaves little to
    /// search.
    void bound_by(const Triangle& tool, const Triangle& face) noexcept TACTUS_NONBLOCKING;
    /// Bounds the distances of queued pairs with an open face. Whether such a pair may meet is
    /// decided in double precision.
    void bound_queued_open() noexcept TACTUS_NONBLOCKING;
    /// Decides whether queued pairs meet: in single precision, and exactly if signs are in doubt.
    void decide_queued() noexcept TACTUS_NONBLOCKING;
    /// Measures, in double precision, the pairs that may be the nearest or contacts. The nearest
    /// come first, which leaves the fewest to measure.
    void measure_candidates() noexcept TACTUS_NONBLOCKING;

    /// Direction between the nearest faces found so far, from the object to the tool, with a length
    /// of at most 1. Valid unless way_number() is 0.
    [[nodiscard]] const Vec3f& way() const noexcept { return way_; }
    [[nodiscard]] std::uint32_t way_number() const noexcept { return way_number_; }
    [[nodiscard]] const Vec3f* find_way() const noexcept
    {
        return way_number_ != 0 ? &way_ : nullptr;
    }

private:
    /// A face of either model, in the object's frame.
    struct MeshFace
    {
        Triangle triangle;
        double error_m{0.0};
    };
    /// Pair of faces that count as the surface, to be measured unless others turn out to be nearer.
    struct Candidate // NOLINT(cppcoreguidelines-pro-type-member-init): written whole.
    {
        FacePair pair;
        float gap; ///< Lower bound on the faces' distance, in quanta of the object.
    };
    static constexpr std::size_t kMaxCandidates = 192;
    using FarthestEnds = std::array<std::size_t, kContactDirections>;

    void add_meeting(const FacePair& pair) noexcept;
    [[nodiscard]] bool do_meet(const FacePair& pair) const noexcept;
    [[nodiscard]] Meeting meeting_of(const FacePair& pair) const noexcept;
    void bound_distances(std::uint32_t apart, std::uint32_t count) noexcept;
    void make_room() noexcept;
    void take_bound(std::uint32_t lane, const FacePair& pair) noexcept;
    [[nodiscard]] double gap_of(const Candidate& candidate) const noexcept;
    void measure(const FacePair& pair) noexcept;
    void leave(const Candidate& candidate) noexcept;
    [[nodiscard]] FarthestEnds farthest_ends() const noexcept;
    void measure_ends() noexcept;
    [[nodiscard]] double tool_error_m(const FacePair& pair) const noexcept;
    /// True if the corners of the pair's object face may not be on the surface.
    [[nodiscard]] bool is_outdated(const FacePair& pair) const noexcept;
    [[nodiscard]] double object_error_m(const FacePair& pair) const noexcept;
    [[nodiscard]] double tolerated_m(const FacePair& pair) const noexcept;
    [[nodiscard]] Triangle tool_triangle(const FacePair& pair) const noexcept;
    [[nodiscard]] Triangle object_triangle(const FacePair& pair) const noexcept;
    void leave_open(const MeshFace& tool_face, const MeshFace& face) noexcept;

    const MeshQuestion& question_;
    MeshFindings& findings_;
    MeshMemory& memory_;
    double tool_quantum_m_; ///< Quantum of the tool's model, in metres of the object's frame.
    double quantum_m_;
    FacePairQueue queue_; ///< Pairs of faces that count as the surface.
    FacePairQueue open_queue_;
    PairDistances distances_; ///< Bounds on the distances of the queued pairs.
    StaticVector<Candidate, kMaxCandidates> candidates_;
    SharedFeatures shared_; ///< Nearest features shared by measured pairs.
    /// Number of the direction, which changes with it; 0 if none was found.
    std::uint32_t way_number_{0};
    Vec3f way_{}; ///< Direction of way().
};

} // namespace tactus
