// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/flaw.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/forest/vertex_forest.hpp"

namespace tactus
{

/// Checks the invariants of a forest; its page table must be sound already.
///
///     faces     each active one is found by its id, in a state that a refined record gave it (or
///               its base state), and that record's vertex is among its corners
///     records   the dependencies of a refined one are refined, and less deep; the faces that it
///               brought are active, and no others
///     tree      has each face with the forest's id, error and corners
///     slots     free ones of the pool are in one list
///     hash      is that of the active faces
///
/// Each face and refined record is visited once, with a look-up for each corner and fan face.
[[nodiscard]] Flaw find_flaw(const VertexForest& forest) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
