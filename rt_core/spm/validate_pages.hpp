// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/flaw.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/spm/page_table.hpp"

namespace tactus
{

/// Holds a page table against what it promises: each slot has one chunk at most and each chunk one
/// slot; records are held only where they are refined, refined only where they are linked, and
/// linked only where their page is here. One look at each slot.
[[nodiscard]] Flaw find_flaw(const PageTable& pages,
                             const ModelCounts& counts) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
