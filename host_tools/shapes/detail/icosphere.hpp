// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"

#include <cstdint>

namespace tactus::detail
{

/// Unit sphere: an icosahedron whose edges are cut into `n` parts each, 20 n^2 faces, 10 n^2 + 2
/// vertices.
[[nodiscard]] TriangleMesh make_icosphere(std::uint32_t n);

} // namespace tactus::detail
