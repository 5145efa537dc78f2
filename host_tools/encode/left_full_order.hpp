// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/simplify.hpp"

#include <cstdint>
#include <vector>

namespace tactus
{

/// The bucket (rank >> 3) of every face in the left-full median order of the mesh.
///
/// The faces are split repeatedly at a median of their centroids, along the longest axis of the
/// centroids' box; the left part gets the largest power of two below the count. The cells of the
/// order are therefore aligned: a face's rank is its path in a radix tree with bits as digits, and
/// eight consecutive ranks are one cell. Faces are compared by centroid, then by number, so the
/// order is deterministic. n log n; 16 B a face.
[[nodiscard]] std::vector<std::uint32_t> left_full_buckets(const QuantisedMesh& mesh);

} // namespace tactus
