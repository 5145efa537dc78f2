// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/changed_face.hpp"
#include "rt_core/refine/refine_question.hpp"
#include "rt_core/spm/ids.hpp"
#include "rt_core/spm/page_table.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <utility>

namespace tactus
{

/// A record that must not be merged yet, in its closure's list, or a free entry.
struct HeldRecord
{
    RecordId record{};
    std::uint32_t next{Closure::kNone};
};

/// A coarse face that is wanted, and its state when it was found.
struct RefineCandidate
{
    /// Least over the questions of distance - error - reach_m + later_m. At most 0: the face is
    /// needed now; above: only ahead of the tool.
    double excess_m{0.0};
    PrimId prim{};
    FaceState state;
};

/// Schedule of the merge checks of a page's records (Coarsener). 328 B.
struct PageWaits
{
    std::array<std::uint32_t, kRecordsPerChunk> next{}; ///< Next record in the bucket, slot x 64 +
                                                        ///< place.
    std::array<std::uint8_t, kRecordsPerChunk> dependents{}; ///< Faces refined further by others.
    std::uint64_t listed{0}; ///< Records that are in a bucket, one bit each.
};

/// Memory of refinement, used by all models of a frame in turn: 29 KiB, and 328 B per page slot for
/// its owner's merge checks. Only held records and merge checks last from frame to frame.
///
/// Haptic thread only.
struct RefineScratch
{
    RefineScratch(Arena& arena, std::size_t page_slots) noexcept
        : heap(arena.take<RefineCandidate>(kRefineHeap))
        , stack(arena.take<RecordId>(kMaxDepth))
        , done(arena.take<RecordId>(kMaxSplitsPerFrame))
        , held(arena.take<HeldRecord>(kMaxHeldRecords))
        , waits(arena.take<PageWaits>(page_slots))
    {
        for (std::uint32_t i = kMaxHeldRecords; i > 0 && !arena.is_measuring(); --i)
        {
            held[i - 1].next = std::exchange(free_held, i - 1);
        }
    }

    std::span<RefineCandidate> heap;
    std::span<RecordId> stack; ///< Records on the path of a depth-first closure.
    std::span<RecordId> done;  ///< Records that the present closure split.
    std::span<HeldRecord> held;
    std::span<PageWaits> waits;              ///< Indexed by page slot.
    std::uint32_t free_held{Closure::kNone}; ///< First free entry.
};

} // namespace tactus
