// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/spm/linker.hpp"
#include "tests/fuzz/coded_model.hpp"

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace tactus::fuzz
{

/// What the transport thread has of one model, with a slot for each chunk: the parsed pages that an
/// input may bring and take away, and the linker over them. After each step the laws of linking are
/// checked against the records themselves.
///
/// Bytes of a chunk are the same whenever it comes: the hashes see to that before it is parsed, and
/// the linker relies on it.
class LinkDesk
{
public:
    explicit LinkDesk(const CodedModel& model);

    /// How many chunks the model has.
    [[nodiscard]] std::uint32_t chunks() const noexcept;
    /// Puts a parsed page into the first free slot and links it; nothing when it is there already.
    void bring(ChunkId chunk, const Page& page);
    /// Nothing when it isn't there.
    void take_away(ChunkId chunk);
    /// Takes at most `limit` of the updates that are owed.
    void take_updates(std::uint32_t limit);
    /// With all updates taken: whoever was told of every change knows what is linked.
    void check_told() const;
    [[nodiscard]] std::uint64_t records_linked_now() const;
    [[nodiscard]] std::uint64_t records_refused() const { return linker_->records_refused(); }

private:
    struct Line
    {
        alignas(Arena::kAlignment) std::array<std::byte, Arena::kAlignment> bytes;
    };

    /// Whether a record and all that it depends on are linked.
    enum class Whole : std::uint8_t
    {
        unknown,
        no,
        yes
    };

    void check_links();
    void check_linked(RecordId id, const VsplitRecord& record, const CodedRecord& coded);
    void check_owners(RecordId id, const VsplitRecord& record) const;
    void check_unlinked(RecordId id, std::vector<Whole>& whole);
    [[nodiscard]] bool is_whole(RecordId id, std::vector<Whole>& whole) const;
    [[nodiscard]] bool owners_are_linked(const VsplitRecord& record) const;
    [[nodiscard]] bool is_linked(RecordId id) const;
    /// Null when it isn't linked.
    [[nodiscard]] const VsplitRecord* find(RecordId id) const;
    [[nodiscard]] std::uint32_t next_of(FaceId face, FaceState state) const;

    const CodedModel& model_;
    ModelCounts counts_;
    std::vector<Line> memory_;
    PageSlots slots_;
    std::optional<LinkPool> pool_;
    std::unique_ptr<Linker> linker_;
    std::vector<std::uint32_t> slot_of_; ///< By chunk; kAway when it isn't here.
    std::vector<ChunkId> chunk_in_;      ///< By slot; none when it is free.
    std::vector<std::uint64_t> told_;    ///< By slot.
    std::vector<Page> parsed_;           ///< By slot: the page as it came.
    /// By record: what it became when it was linked first, without `next`.
    std::vector<std::optional<VsplitRecord>> became_;
    std::vector<bool> is_stuck_; ///< By record: found refused since its chunk came.
    std::uint64_t found_refused_{0};
    bool has_taken_away_{false};
};

} // namespace tactus::fuzz
