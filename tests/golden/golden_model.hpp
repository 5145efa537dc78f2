// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/prepare.hpp"
#include "host_tools/simplify/simplify.hpp"

namespace tactus
{

/// Closed shape of 512 faces, from integers alone, so that its bytes never change.
[[nodiscard]] PreparedMesh make_golden_mesh();

/// Collapses the closed `mesh` to at most `base_faces` faces by the simplest legal rule: vertices
/// and their neighbours in order of number, disjoint stars in a round. The bounds add up edge
/// lengths: loose but sound. Shares nothing with the simplifier, so golden bytes do not depend on
/// it.
[[nodiscard]] Simplification collapse_plainly(const QuantisedMesh& mesh, std::size_t base_faces);

} // namespace tactus
