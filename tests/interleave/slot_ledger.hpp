// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/cache/chunk_cache.hpp"
#include "rt_core/spm/page_table.hpp"
#include "tests/unit/transport/tiny_model.hpp"
#include "transport/chunk_link.hpp"
#include "transport/courier.hpp"

#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace tactus::interleave
{

/// A model, and what its chunks are when parsed, before any link: the same for all runs.
struct Truth
{
    explicit Truth(const test::TinyModel& tiny);

    const test::TinyModel& model;
    ModelHeader header;
    std::vector<Page> parsed; ///< By chunk.
    /// Records of chunks 0 and 1 that depend on no other chunk.
    std::array<std::uint64_t, 2> linkable{};

private:
    [[nodiscard]] bool is_linkable(RecordId record) const;
    [[nodiscard]] bool depends_on_linkable(std::uint32_t id) const;
};

/// Who owns which page slot, kept from what passes the door and from nothing inside of courier,
/// linker, cache or page table; these are held against it. The first contradiction is kept.
class SlotLedger final : public PieceSink
{
public:
    SlotLedger(const Truth& truth, const PageSlots& slots, const PageTable& pages);

    /// What the courier is about to hand over (Courier::copy_pieces_to()).
    void receive(ContentKey key, std::span<const std::byte> bytes) override;
    /// The courier begins a step: what is freed by now it will take back.
    void begin_step() { freed_at_step_ = freed_; }
    /// After the cache adopted.
    void adopted(const DoorTake& take);
    /// After any verb of the haptic thread: pages that are away now were freed.
    void find_freed();
    /// After any verb: every slot is in one place, every page holds what the model says.
    void check(const Courier& courier, const SlotDoor& door, const ChunkCache& cache);

    /// Keeps `what` when it does not hold and nothing failed before; `number` is of what it is
    /// about.
    void require(bool holds, const char* what, std::uint32_t number = 0);
    /// Link updates that came in time, and those of pages that were freed meanwhile.
    [[nodiscard]] std::uint64_t updates() const { return updates_; }
    [[nodiscard]] std::uint64_t late_updates() const { return late_updates_; }
    [[nodiscard]] bool has_failed() const { return !failure_.empty(); }
    [[nodiscard]] const std::string& failure() const { return failure_; }
    /// Records of a chunk that the haptic thread was told of and may use.
    [[nodiscard]] std::uint64_t told(ChunkId chunk) const;

private:
    struct Slot
    {
        ChunkId chunk{}; ///< None: not with the haptic thread.
        std::uint64_t told{0};
        std::uint32_t freed_as{0}; ///< The how manieth freed slot it was last.
    };
    struct HandOver
    {
        ContentKey key;
        std::uint32_t freed{0}; ///< Slots that the courier had taken back.
    };

    void adopt(const DoorEvent& arrival);
    void update(const DoorEvent& update);
    void check_page(std::uint32_t slot);
    void check_links(const VsplitRecord& record, std::uint32_t id);
    [[nodiscard]] bool is_told(std::uint32_t record) const;
    [[nodiscard]] bool has_all_it_needs(std::uint32_t record) const;

    const Truth& truth_;
    const PageSlots& pages_;
    const PageTable& table_;
    std::vector<Slot> slots_;
    std::deque<HandOver> on_their_way_;
    std::uint32_t handed_chunks_{0}; ///< Not adopted yet.
    std::uint32_t handed_indices_{0};
    std::uint32_t freed_{0};
    std::uint32_t freed_at_step_{0};
    std::uint64_t updates_{0};
    std::uint64_t late_updates_{0};
    std::string failure_;
};

} // namespace tactus::interleave
