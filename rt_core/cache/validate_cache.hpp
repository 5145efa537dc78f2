// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/flaw.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/cache/chunk_cache.hpp"

namespace tactus
{

/// Checks the invariants of a chunk cache; its page table must be sound already.
///
///     slots      each holds a page or an index page, or counts as the transport thread's, as do
///                slots on their way there
///     index      each index page has one slot, found by its number, with as many chunks as it
///                should have
///     requests   each piece is requested once and is not resident
///
/// One check per slot.
[[nodiscard]] Flaw find_flaw(const ChunkCache& cache) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
