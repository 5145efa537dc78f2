// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/simplify.hpp"

#include <cstdint>

namespace tactus
{

/// The largest distance, in quanta, of `samples` points of the mesh to the base mesh that it was
/// simplified to: the one-sided Hausdorff distance from below. The points are spread evenly by
/// area, one at a random place of each equal share. A certificate that holds is never smaller than
/// this. At least one sample. Some microseconds each, and two passes over the faces.
[[nodiscard]] double sampled_distance_to_base(const QuantisedMesh& mesh,
                                              const Simplification& simplification,
                                              std::uint32_t samples, std::uint64_t seed);

} // namespace tactus
