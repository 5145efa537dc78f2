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
///     slots      each is a page's (or an index page's) here, or counted as the transport thread's;
///                a slot that waits to be taken back is the transport thread's
///     index      each index page has one slot, found by its number, with as many chunks as it
///                should have
///     requests   each piece is requested once and is not resident
///
/// One check per slot.
[[nodiscard]] Flaw find_flaw(const ChunkCache& cache) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
