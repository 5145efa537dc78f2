// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"

#include <cstdint>

namespace tactus::detail
{

/// Closed plate of 100 x 100 mm over z = 0, both sides cut into cells x cells squares: 4 x cells x
/// (cells + 2) faces. At least one cell.
[[nodiscard]] TriangleMesh make_plate(std::uint32_t cells, double thickness_m);

} // namespace tactus::detail
