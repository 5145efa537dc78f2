// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/boundary_quadrics.hpp"
#include "host_tools/simplify/collapse_mesh.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "host_tools/simplify/surface_samples.hpp"

#include <cstdint>
#include <tuple>
#include <vector>

namespace tactus
{

/// Degree to which a collapse spoils the faces that it changes. A round takes the least spoiling
/// collapses and uses the next level only if it would starve: a strict guard once left a needle
/// sphere stuck at 141,584 of 152,000 faces.
enum class Spoils : std::uint8_t
{
    nothing,
    thinness, ///< A face becomes thin, and more than twice as thin as it was.
    fold,     ///< A face rotates by more than 78 degrees, but does not flip.
    face,     ///< A face flips over or loses its area.
};

inline constexpr std::uint32_t kSpoilLevels = 4;

/// The worst effect on a fan face. A face without area cannot be spoilt.
[[nodiscard]] Spoils spoils(const QuantisedMesh& mesh, const Star& star) noexcept;

/// The best collapse of one vertex.
struct Candidate
{
    static constexpr std::uint32_t kNone = 0xFFFF'FFFFU;

    double cost{0}; ///< Cost in quanta^4.
    std::uint32_t vertex{0};
    /// Vertex onto which `vertex` moves; kNone if no collapse is legal.
    std::uint32_t parent{kNone};
    Spoils spoils{Spoils::nothing};
};

/// Orders candidates, best first. The order is total, since each vertex has one candidate.
[[nodiscard]] inline bool operator<(const Candidate& a, const Candidate& b) noexcept
{
    return std::tie(a.spoils, a.cost, a.vertex) < std::tie(b.spoils, b.cost, b.vertex);
}

/// Scratch memory of one worker.
struct CandidateScratch
{
    StarSamples samples;
    std::vector<double> nearest;
    std::vector<double> squared;
};

/// Rule that chooses a vertex's parent among its neighbours.
enum class Priority : std::uint8_t
{
    quadric,  ///< The cheapest legal neighbour.
    measured, ///< Least measured error among the six cheapest legal neighbours.
};

/// Read-only input of the search for candidates.
struct CandidateInput
{
    const QuantisedMesh& mesh;
    const CollapseMesh& current;
    const BoundaryQuadrics& boundary;
    const SurfaceSamples& samples; ///< Surface samples; read only with Priority::measured.
    Priority priority{Priority::quadric};
};

/// Finds the vertex's best legal collapse: the lowest Spoils level, then the least cost. Between
/// equal costs the first neighbour in the vertex's ring is chosen.
[[nodiscard]] Candidate find_candidate(const CandidateInput& input, std::uint32_t vertex,
                                       CandidateScratch& scratch);

} // namespace tactus
