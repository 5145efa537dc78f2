// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/cache/chunk_cache.hpp"
#include "rt_core/spm/page_table.hpp"
#include "tests/unit/transport/tiny_model.hpp"
#include "transport/chunk_link.hpp"
#include "transport/chunk_loader.hpp"

#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace tactus::interleave
{

/// Model with its parsed, unlinked chunks: the same for all runs.
struct Truth
{
    explicit Truth(const test::TinyModel& tiny);

    const test::TinyModel& model;
    ModelHeader header;
    std::vector<Page> parsed; ///< Pages by chunk.
    /// Records of chunks 0 and 1 without dependencies on other chunks.
    std::array<std::uint64_t, 2> linkable{};

private:
    [[nodiscard]] bool is_linkable(RecordId record) const;
    [[nodiscard]] bool depends_on_linkable(std::uint32_t id) const;
};

/// Owners of the page slots, derived only from the data through the queues and compared with
/// loader, linker, cache and page table. Keeps the first contradiction.
class SlotLedger final : public PieceSink
{
public:
    SlotLedger(const Truth& truth, const PageSlots& slots, const PageTable& pages);

    /// Receives a piece that the loader is about to hand over (ChunkLoader::copy_pieces_to()).
    void receive(ContentKey key, std::span<const std::byte> bytes) override;
    /// Marks the start of a step, which will take back all slots freed so far.
    void begin_step() { freed_at_step_ = freed_; }
    /// Checks after the cache adopted.
    void adopted(const QueueTake& take);
    /// Finds pages freed by a verb of the haptic thread.
    void find_freed();
    /// Checks after any verb that every slot is in one place and every page equals the model's.
    void check(const ChunkLoader& chunk_loader, const SlotQueues& queues, const ChunkCache& cache);

    /// Keeps `what` with `number` if it does not hold and nothing failed before.
    void require(bool holds, const char* what, std::uint32_t number = 0);
    /// Link updates in time, and those of pages freed meanwhile.
    [[nodiscard]] std::uint64_t updates() const { return updates_; }
    [[nodiscard]] std::uint64_t late_updates() const { return late_updates_; }
    [[nodiscard]] bool has_failed() const { return !failure_.empty(); }
    [[nodiscard]] const std::string& failure() const { return failure_; }
    /// Records of a chunk that were notified to the haptic thread for use.
    [[nodiscard]] std::uint64_t told(ChunkId chunk) const;

private:
    struct Slot
    {
        ChunkId chunk{}; ///< Chunk; empty: not on the haptic thread.
        std::uint64_t told{0};
        std::uint32_t freed_as{0}; ///< Order of its last freeing.
    };
    struct HandOver
    {
        ContentKey key;
        std::uint32_t freed{0}; ///< Slots that the loader had taken back.
    };

    void adopt(const QueueEvent& arrival);
    void update(const QueueEvent& update);
    void check_page(std::uint32_t slot);
    void check_links(const VsplitRecord& record, std::uint32_t id);
    [[nodiscard]] bool is_told(std::uint32_t record) const;
    [[nodiscard]] bool has_all_it_needs(std::uint32_t record) const;

    const Truth& truth_;
    const PageSlots& pages_;
    const PageTable& table_;
    std::vector<Slot> slots_;
    std::deque<HandOver> on_their_way_;
    std::uint32_t handed_chunks_{0}; ///< Handed-over chunks that are not adopted yet.
    std::uint32_t handed_indices_{0};
    std::uint32_t freed_{0};
    std::uint32_t freed_at_step_{0};
    std::uint64_t updates_{0};
    std::uint64_t late_updates_{0};
    std::string failure_;
};

} // namespace tactus::interleave
