// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/simplify.hpp"

#include <cstdint>

namespace tactus
{

/// The largest distance, in quanta, from `samples` points of the mesh to its simplified base mesh:
/// a lower estimate of the one-sided Hausdorff distance. The points are spread evenly by area, one
/// at a random place of each equal share. A valid certificate is never smaller. `samples` must be
/// at least 1. Costs some microseconds a sample, and two passes over the faces.
[[nodiscard]] double sampled_distance_to_base(const QuantisedMesh& mesh,
                                              const Simplification& simplification,
                                              std::uint32_t samples, std::uint64_t seed);

} // namespace tactus
