// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/distance_kernel.inc"

namespace tactus
{

constinit const SquaredDistances kPortableSquaredDistances = squared_distances;

} // namespace tactus
