// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/spm/coded_record.hpp"
#include "rt_core/spm/header.hpp"
#include "rt_core/spm/linker.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace tactus::fuzz
{

/// Pieces of a small model as this build codes them, so that fuzzing always uses the present
/// version.
struct CodedModel
{
    std::vector<std::byte> header_bytes;
    ModelHeader header; ///< View of header_bytes.
    std::vector<std::byte> base;
    std::vector<std::vector<std::byte>> chunks;
};

/// Generated shapes. More faces mean more chunks: one for each 128.
enum class Lump : std::uint32_t
{
    closed, ///< Bumpy sphere of 720 faces.
    open,   ///< Terrain of about 800 faces, with a border.
};

/// Model made by the encoder, once a process. Ends the program if a step refuses.
[[nodiscard]] const CodedModel& coded_model(Lump lump);

/// Change of a chunk: of its bytes or of a record parsed from it.
struct Edit
{
    enum Kind : std::uint32_t
    {
        set_byte,
        flip_bit,
        cut,
        insert_byte,
        set_anchor, ///< First kind of a change of records.
        set_place,
        set_fan,
        set_other,
        set_residual,
        set_error,
        set_bucket,
        kinds
    };

    std::uint32_t chunk{0};
    Kind kind{set_byte};
    std::uint32_t place{0};
    std::uint32_t value{0};
};

/// Applies an edit of bytes; no effect for one of a record. `bytes` is never empty.
void edit_bytes(const Edit& edit, std::vector<std::byte>& bytes);

/// Changes a record as another chunk could code it, which reaches records that random bytes hardly
/// produce; `place` / 64, below 1024, is the new number, possibly one that no chunk codes. No
/// effect for an edit of bytes.
void edit_record(const Edit& edit, const ModelCounts& counts, CodedRecord& record);

/// Transport thread's view of one model, with a slot for each chunk: the parsed pages that an input
/// may add and remove, and the linker over them. After each step the laws of linking are checked
/// against the records.
///
/// Bytes of a chunk are the same whenever it arrives: the hashes ensure that before parsing, and
/// the linker relies on it.
class LinkDesk
{
public:
    explicit LinkDesk(const CodedModel& model);

    /// Number of the model's chunks.
    [[nodiscard]] std::uint32_t chunks() const noexcept;
    /// Puts a parsed page into the first free slot and links it; no effect if it is present.
    void bring(ChunkId chunk, const Page& page);
    /// Removes a chunk; no effect if it is absent.
    void take_away(ChunkId chunk);
    /// Takes at most `limit` of the pending updates.
    void take_updates(std::uint32_t limit);
    /// Checks, after all updates, that the changes notified so far describe the linked records.
    void check_told() const;
    [[nodiscard]] std::uint64_t records_linked_now() const;
    [[nodiscard]] std::uint64_t records_refused() const { return linker_->records_refused(); }

private:
    struct Line
    {
        alignas(Arena::kAlignment) std::array<std::byte, Arena::kAlignment> bytes;
    };

    /// State of a record with all its dependencies: linked or not.
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
    /// Linked record; null if it is not linked.
    [[nodiscard]] const VsplitRecord* find(RecordId id) const;
    [[nodiscard]] std::uint32_t next_of(FaceId face, FaceState state) const;

    const CodedModel& model_;
    ModelCounts counts_;
    std::vector<Line> memory_;
    PageSlots slots_;
    std::optional<LinkPool> pool_;
    std::unique_ptr<Linker> linker_;
    std::vector<std::uint32_t> slot_of_; ///< Slot by chunk; kAway if absent.
    std::vector<ChunkId> chunk_in_;      ///< Chunk by slot; empty if free.
    std::vector<std::uint64_t> told_;    ///< Notified records by slot.
    std::vector<Page> parsed_;           ///< Parsed page by slot, as it arrived.
    /// Record as it was linked first, without `next`.
    std::vector<std::optional<VsplitRecord>> became_;
    std::vector<bool> is_stuck_; ///< True for a record that was refused since its chunk arrived.
    std::uint64_t found_refused_{0};
    bool has_taken_away_{false};
};

} // namespace tactus::fuzz
