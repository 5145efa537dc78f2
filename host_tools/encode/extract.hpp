// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/decoded_model.hpp"
#include "host_tools/encode/zone.hpp"
#include "host_tools/mesh/triangle_mesh.hpp"

#include <cstdint>
#include <optional>

// Any thread, except the haptic one: calls allocate, and work on their arguments alone.
namespace tactus
{

/// Demands on an extracted mesh: the base mesh is refined until each is met.
struct ExtractRequest
{
    /// Maximum number of faces; within it the most important records are split. The other demands
    /// have priority and may need more, and the base mesh may have more.
    std::optional<std::uint32_t> faces;
    std::optional<double> error_m; ///< Maximum error bound of a face; 0 or more (unchecked).
    std::optional<Zone> zone;      ///< Zone of full resolution, in the source's frame.
};

/// Result of an extraction.
struct Extraction
{
    TriangleMesh mesh;           ///< Mesh in the source's frame, in metres.
    double error_max_m{0.0};     ///< Largest error bound of a face of `mesh`.
    std::uint32_t zone_faces{0}; ///< Number of source faces that touch the zone; all are in `mesh`.
};

/// Extracts a mesh from a sound model (every record can be split). The result is the cut with the
/// fewest splits, within the dependencies, that meets error and zone; then further splits, the most
/// important first, fill the allowed number of faces. Linear except for one sort; 60 B a face
/// beside the model.
[[nodiscard]] Extraction extract(const DecodedModel& model, const ExtractRequest& request);

} // namespace tactus
