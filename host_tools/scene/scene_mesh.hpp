// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"

#include <string>

namespace tactus
{

/// A mesh of a scene file.
struct SceneMesh
{
    TriangleMesh mesh; ///< Mesh; without faces if no part has a surface.
    /// Parts without a surface, such as "2 primitives of LINES"; empty if there are none.
    std::string left_out;
};

} // namespace tactus
