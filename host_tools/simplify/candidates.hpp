// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/boundary_quadrics.hpp"
#include "host_tools/simplify/collapse_mesh.hpp"
#include "host_tools/simplify/shape_guard.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "host_tools/simplify/surface_samples.hpp"

#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

namespace tactus
{

/// The best collapse of one vertex.
struct Candidate
{
    static constexpr std::uint32_t kNone = 0xFFFF'FFFFU;

    double cost{0}; ///< Cost in quanta^4.
    std::uint32_t vertex{0};
    std::uint32_t parent{kNone}; ///< Parent; kNone if no collapse is legal.
    Spoils spoils{Spoils::nothing};
};

/// Best first; a total order, since a vertex has one candidate.
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

/// Ranking of candidates.
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
    const SurfaceSamples& samples; ///< Samples, read when errors are measured.
    Priority priority{Priority::quadric};
};

/// The vertex's best collapse: of the least spoiling level, then by cost, ties to the neighbour
/// that comes first around the vertex.
[[nodiscard]] Candidate find_candidate(const CandidateInput& input, std::uint32_t vertex,
                                       CandidateScratch& scratch);

} // namespace tactus
