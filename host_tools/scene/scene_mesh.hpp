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
    TriangleMesh mesh;    ///< Without faces: nothing of it has a surface.
    std::string left_out; ///< What has none, such as "2 primitives of LINES"; empty: nothing.
};

} // namespace tactus
