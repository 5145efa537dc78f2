// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/cache/chunk_cache.hpp"
#include "rt_core/cache/slot_door.hpp"
#include "rt_core/spm/linker.hpp"
#include "rt_core/spm/page_table.hpp"
#include "tests/interleave/slot_ledger.hpp"
#include "tests/interleave/verb_link.hpp"
#include "transport/courier.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tactus::interleave
{

/// What either thread may do next; the haptic thread up to be_late.
enum class Verb : std::uint8_t
{
    adopt,
    want_a,   ///< A frame that needs chunk 0,
    want_b,   ///< chunk 1,
    want_c,   ///< chunk 2,
    want_all, ///< all of the model, which is one page more than there are slots.
    evict,    ///< Every page that isn't pinned.
    pin,      ///< A page that isn't, by refining a record.
    unpin,    ///< All.
    be_late,  ///< A frame so late that unanswered wishes expire.
    step,     ///< With a link as its Weather says, and the next ones in its order.
    step_holding,
    step_losing,
    step_damaging,
    step_reversing,
    step_repeating,
    change_host, ///< It goes away, or another one comes.
    /// A step with a frame in the middle: adopt, evict, want everything.
    step_frame_at_request,
    step_frame_at_piece,
    step_frame_at_hand_over,
};
inline constexpr std::uint32_t kVerbs = 19;

[[nodiscard]] const char* name_of(Verb verb);

/// The product's courier, linker, cache and page table for a model of three chunks, with two page
/// slots; a link that does as it is told; and a ledger beside it.
///
/// The verbs are whole: what one does to several queues is not cut up by the other thread, except
/// in the middle of a step. Finer cuts add little. A thread learns of the other only by what it
/// pops and by counts; pops come in the order of pushes, and whoever takes a wish has taken what
/// was freed before it (QueueOrders, DoorOrders). So a cut decides no more than how far into the
/// other's pushes a thread sees:
/// - `adopt` sees one queue, up to some hand-over; those within a step are the middle steps' cuts.
/// - A step sees wishes up to some point and freed slots up to that or a later one. Between a
///   freeing and the wish behind it that is what a step after `evict` sees, before `want_...`.
///   What is pushed while the step runs is there in the middle steps.
/// - Counts that are out of date make for less room or fewer values, never more.
class DoorWorld
{
public:
    static constexpr std::uint32_t kPages = 2;
    static constexpr std::size_t kBytes = std::size_t{256} << 10U;

    /// `memory` is used anew by each world; starts on Arena::kAlignment.
    DoorWorld(const Truth& truth, std::span<std::byte> memory);

    /// The verbs that do something now.
    [[nodiscard]] std::vector<Verb> offered() const;
    /// Does it and checks. False when it came to the same as a plain `step`.
    [[nodiscard]] bool apply(Verb verb);
    /// With a good link and no pins: the first two chunks come, linked as far as they can be
    /// without the third, and nothing stays open. Where nothing was lost on the way, also without
    /// any wish that expires.
    void settle();

    [[nodiscard]] const std::string& failure() const { return ledger_.failure(); }
    [[nodiscard]] const CourierCounters& counters() const { return courier_.counters(); }
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

    /// Runs a frame when it is told of a hand-over.
    struct Copies final : PieceSink
    {
        explicit Copies(DoorWorld& owner) : world(owner) {}
        void receive(ContentKey key, std::span<const std::byte> bytes) override;
        DoorWorld& world;
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
    Courier courier_;
    WorkCounters work_{};
    std::uint32_t frame_{ChunkCache::kFirstFrame};
    std::int64_t now_ns_{0};
    bool had_middle_{false};
    bool had_losses_{false}; ///< Of the link, or wishes that expired.
};

} // namespace tactus::interleave
