// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/decoded_model.hpp"
#include "host_tools/encode/zone.hpp"
#include "host_tools/mesh/triangle_mesh.hpp"

#include <cstdint>
#include <optional>

// Any thread, but not the haptic one: calls allocate, and work on their arguments alone.
namespace tactus
{

/// Which mesh to take out of a model: the base mesh, refined by each demand that is made.
struct ExtractRequest
{
    /// Splits what matters most while the mesh has at most so many faces. The other demands come
    /// first and may need more, and the base mesh may have more.
    std::optional<std::uint32_t> faces;
    std::optional<double> error_m; ///< No face's bound is to exceed this; 0 or more (unchecked).
    std::optional<Zone> zone;      ///< Full resolution in here; in the source's frame.
};

struct Extraction
{
    TriangleMesh mesh;           ///< In the source's frame, in metres.
    double error_max_m{0.0};     ///< The largest bound of its faces.
    std::uint32_t zone_faces{0}; ///< Source faces that the zone touches; the mesh has them all.
};

/// Takes a mesh out of a model that has been found sound (every record can be split). Among the
/// cuts that obey the dependencies, the one with the fewest splits that meets error and zone; then
/// the number of faces is filled up. Linear but for one sort; 60 B a face beside the model.
[[nodiscard]] Extraction extract(const DecodedModel& model, const ExtractRequest& request);

} // namespace tactus
