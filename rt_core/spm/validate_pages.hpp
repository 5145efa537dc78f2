// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/flaw.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/spm/page_table.hpp"

namespace tactus
{

/// Checks the invariants of a page table: each slot has one chunk at most and each chunk one slot;
/// held records are refined, refined ones linked, and linked ones on resident pages. One check per
/// slot.
[[nodiscard]] Flaw find_flaw(const PageTable& pages,
                             const ModelCounts& counts) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
