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

    double cost{0}; ///< In quanta^4.
    std::uint32_t vertex{0};
    std::uint32_t parent{kNone}; ///< kNone when no collapse is legal.
    Spoils spoils{Spoils::nothing};
};

/// Best first; a total order, since a vertex has one candidate.
[[nodiscard]] inline bool operator<(const Candidate& a, const Candidate& b) noexcept
{
    return std::tie(a.spoils, a.cost, a.vertex) < std::tie(b.spoils, b.cost, b.vertex);
}

/// Scratch of one worker.
struct CandidateScratch
{
    StarSamples samples;
    std::vector<double> nearest;
    std::vector<double> squared;
};

/// How candidates are ranked.
enum class Priority : std::uint8_t
{
    quadric,  ///< The cheapest legal neighbour.
    measured, ///< Of the six cheapest legal neighbours the one with the least measured error.
};

/// What the candidates are found in; only read.
struct CandidateInput
{
    const QuantisedMesh& mesh;
    const CollapseMesh& current;
    const BoundaryQuadrics& boundary;
    const SurfaceSamples& samples; ///< Read when errors are measured.
    Priority priority{Priority::quadric};
};

/// The vertex's best collapse: the least spoiling ones only, then by cost, ties to the neighbour
/// that comes first round the vertex.
[[nodiscard]] Candidate find_candidate(const CandidateInput& input, std::uint32_t vertex,
                                       CandidateScratch& scratch);

} // namespace tactus
