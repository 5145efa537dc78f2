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

/// Decides intersection and distance of near face pairs. Single precision with proven bands comes
/// first, exact arithmetic decides open cases that matter. Reports to the findings. Haptic thread.
/// Valid for one query.
class FaceDecision // NOLINT(cppcoreguidelines-pro-type-member-init): distances_ are written first.
{
public:
    FaceDecision(const MeshQuestion& question, MeshFindings& findings,
                 MeshMemory& memory) noexcept TACTUS_NONBLOCKING;

    /// Adds a pair of faces that may matter. Arguments are those of FacePairQueue::add().
    void add(const FacePair& pair, bool is_coarse, const PlacedBlock& tool,
             const BlockGeometry& block, const VertexRows& rows,
             float slack) noexcept TACTUS_NONBLOCKING;
    /// Bounds the distance by the remembered faces, before all others. Their distance leaves little
    /// to search.
    void bound_by(const Triangle& tool, const Triangle& face) noexcept TACTUS_NONBLOCKING;
    /// Takes bounds from queued pairs with a coarse face. Intersection with the other surface is
    /// decided in double precision.
    void bound_queued_coarse() noexcept TACTUS_NONBLOCKING;
    /// Decides intersection of queued pairs: in single precision, and exactly if signs are in
    /// doubt.
    void decide_queued() noexcept TACTUS_NONBLOCKING;
    /// Measures candidates for nearest or contact, in double precision. The nearest come first,
    /// which leaves the least to measure.
    void measure_candidates() noexcept TACTUS_NONBLOCKING;

    /// Direction between the nearest faces found, from the object to the tool, not longer than 1.
    /// Its number is 0 if none was found.
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
    /// Exact faces to be measured unless others turn out to be nearer.
    struct Candidate // NOLINT(cppcoreguidelines-pro-type-member-init): written whole.
    {
        FacePair pair;
        float gap; ///< Lower bound on their distance, in quanta.
    };
    static constexpr std::size_t kMaxCandidates = 192;
    using FarthestEnds = std::array<std::size_t, kContactDirections>;

    [[nodiscard]] bool do_meet(const FacePair& pair) const noexcept;
    [[nodiscard]] Meeting meeting_of(const FacePair& pair) const noexcept;
    void bound_distances(std::uint32_t apart, std::uint32_t count) noexcept;
    void make_room() noexcept;
    void take_bound(std::uint32_t lane, const FacePair& pair) noexcept;
    [[nodiscard]] double gap_of(const Candidate& candidate) const noexcept;
    void measure(const FacePair& pair) noexcept;
    [[nodiscard]] FarthestEnds farthest_ends() const noexcept;
    void measure_ends() noexcept;
    [[nodiscard]] double tool_error_m(const FacePair& pair) const noexcept;
    [[nodiscard]] double object_error_m(const FacePair& pair) const noexcept;
    [[nodiscard]] Triangle tool_triangle(const FacePair& pair) const noexcept;
    [[nodiscard]] Triangle object_triangle(const FacePair& pair) const noexcept;
    void leave_coarse(const MeshFace& tool_face, const MeshFace& face) noexcept;
    void bound_by_corners(const MeshFace& tool_face, const MeshFace& face) noexcept;

    const MeshQuestion& question_;
    MeshFindings& findings_;
    MeshMemory& memory_;
    double tool_quantum_m_; ///< Quantum of the tool in the object's frame.
    double quantum_m_;
    FacePairQueue queue_; ///< Exact pairs.
    FacePairQueue coarse_queue_;
    PairDistances distances_; ///< Bounds for the queue.
    StaticVector<Candidate, kMaxCandidates> candidates_;
    SharedFeatures shared_;       ///< Features shared among measured pairs.
    std::uint32_t way_number_{0}; ///< Number of the direction; 0 if none was found.
    Vec3f way_{};                 ///< Direction between the nearest faces found.
};

} // namespace tactus
