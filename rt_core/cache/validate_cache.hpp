// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/flaw.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/cache/chunk_cache.hpp"

namespace tactus
{

/// Holds a chunk cache against what it promises; its page table must be sound already.
///
///     slots     each is a page's (or an index page's) here, or counted as the transport thread's;
///               what waits to be taken back is the transport thread's
///     index     each index page has one slot, found by its number, with as many chunks as it
///               should have
///     wishes    each piece is asked for once and is not here
///
/// One look at each slot.
[[nodiscard]] Flaw find_flaw(const ChunkCache& cache) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
