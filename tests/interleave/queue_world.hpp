// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/cache/chunk_cache.hpp"
#include "rt_core/cache/slot_queues.hpp"
#include "rt_core/spm/linker.hpp"
#include "rt_core/spm/page_table.hpp"
#include "tests/interleave/slot_ledger.hpp"
#include "tests/interleave/verb_link.hpp"
#include "transport/chunk_loader.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tactus::interleave
{

/// Next operation of either thread; those of the haptic thread are up to be_late.
enum class Verb : std::uint8_t
{
    adopt,
    want_a,   ///< Frame that needs chunk 0.
    want_b,   ///< Frame that needs chunk 1.
    want_c,   ///< Frame that needs chunk 2.
    want_all, ///< Frame that needs the whole model, one page more than there are slots.
    evict,    ///< Evicts every page that is not pinned.
    pin,      ///< Pins an unpinned page by refining a record.
    unpin,
    be_late, ///< Frame so late that unanswered requests expire.
    step,    ///< Step; this and the next verbs are in the order of Weather.
    step_holding,
    step_losing,
    step_damaging,
    step_reversing,
    step_repeating,
    change_server, ///< The server disappears, or another one appears.
    /// Steps with a frame in the middle: adopt, evict, want everything.
    step_frame_at_request,
    step_frame_at_piece,
    step_frame_at_hand_over,
};
inline constexpr std::uint32_t kVerbs = 19;

[[nodiscard]] const char* name_of(Verb verb);

/// The product's loader, linker, cache and page table for a model of three chunks with two page
/// slots, a controlled link, and a ledger.
///
/// The verbs are atomic: operations on several queues are not interrupted by the other thread,
/// except within a step. Finer cuts add little. A thread learns of the other only by its pops and
/// by counts; pops are in the order of pushes, and after taking a request all earlier freed slots
/// were taken (QueueOrders, SlotQueueOrders). A cut thus only decides how many of the other's
/// pushes a thread sees:
/// - `adopt` sees one queue up to some hand-over; those within a step are the middle steps' cuts.
/// - A step sees requests up to some point and freed slots up to that or a later one. Between a
///   freeing and the request behind it that is a step after `evict` and before `want_...`. Pushes
///   during the step are in the middle steps.
/// - Outdated counts mean less capacity or fewer values, never more.
class QueueWorld
{
public:
    static constexpr std::uint32_t kPages = 2;
    static constexpr std::size_t kBytes = std::size_t{256} << 10U;

    /// Starts a world in `memory`, which is reused and aligned to Arena::kAlignment.
    QueueWorld(const Truth& truth, std::span<std::byte> memory);

    /// Verbs that have an effect now.
    [[nodiscard]] std::vector<Verb> offered() const;
    /// Applies a verb and checks. False if the result was that of a plain `step`.
    [[nodiscard]] bool apply(Verb verb);
    /// Runs with a good link and no pins: the first two chunks arrive, linked as far as possible
    /// without the third, and nothing stays open. If nothing was lost, no request expires either.
    void settle();

    [[nodiscard]] const std::string& failure() const { return ledger_.failure(); }
    [[nodiscard]] const ChunkLoaderCounters& counters() const { return chunk_loader_.counters(); }
    [[nodiscard]] const SlotLedger& ledger() const { return ledger_; }
    [[nodiscard]] std::uint64_t evictions() const { return cache_.evictions(); }

private:
    void adopt();
    void want(std::span<const ChunkId> chunks, std::uint32_t frames = 1);
    void evict();
    void pin();
    void unpin();
    void frame_in_the_middle();
    [[nodiscard]] bool step(Verb verb);
    [[nodiscard]] bool is_settled() const;
    [[nodiscard]] bool was_anything_lost() const;
    [[nodiscard]] std::uint32_t page_to_pin() const;

    /// Runs a frame at a hand-over.
    struct Copies final : PieceSink
    {
        explicit Copies(QueueWorld& owner) : world(owner) {}
        void receive(ContentKey key, std::span<const std::byte> bytes) override;
        QueueWorld& world;
        bool runs_frame{false};
    };

    const Truth& truth_;
    Arena arena_;
    PageSlots slots_;
    CachePool pool_;
    PageTable pages_;
    LinkPool link_pool_;
    Linker linker_;
    ChunkCache cache_;
    VerbLink link_;
    SlotLedger ledger_;
    Copies copies_;
    ChunkLoader chunk_loader_;
    WorkCounters work_{};
    std::uint32_t frame_{ChunkCache::kFirstFrame};
    std::int64_t now_ns_{0};
    bool had_middle_{false};
    bool had_losses_{false}; ///< True if the link lost pieces, or requests expired.
};

} // namespace tactus::interleave
