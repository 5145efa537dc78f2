// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/model_id.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/frame_output.hpp"
#include "rt_core/records/surface_edit.hpp"
#include "transport/edit_content.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tactus
{

/// Passes edits from the transport thread to the haptic thread, in order. It holds its edits in
/// fixed memory, 160 KiB. Neither thread waits for the other: the transport thread offers an edit
/// again if the mailbox is full.
///
/// Each side writes only its own count, as in SpscQueue. The edits stay in place while a frame
/// reads them.
class EditMailbox
{
public:
    /// Number of edits in the mailbox at most: those of 64 frames, between two polls of a network.
    static constexpr std::size_t kEdits = 64;
    /// Edits of one frame: a second one would leave little of a fast loop's budget of work.
    static constexpr std::size_t kEditsPerFrame = 1;
    static_assert(kEditsPerFrame <= kMaxEditsPerFrame);

    EditMailbox() : cells_(kEdits) {}

    /// Transport thread: adds an edit. False, with nothing changed, if the mailbox is full. The
    /// edit has at most kMaxEditFaces faces of each kind (asserted).
    [[nodiscard]] bool try_put(ModelId model, const EditContent& edit) noexcept;

    /// Haptic thread: edits for this frame, at most kEditsPerFrame, valid until done().
    /// Allocates nothing.
    [[nodiscard]] std::span<const SurfaceEdit> edits() noexcept;
    /// Haptic thread: returns the cells of the edits from the last edits(). Nothing happens if
    /// there were none. `models` are those after the frame, and show the edits that it refused.
    void done(std::span<const ModelOutput> models) noexcept;

    /// Transport thread: model of the last edit that a frame refused since the last call; none if
    /// there was none.
    [[nodiscard]] std::optional<ModelId> take_refused_model() noexcept;

    /// Any thread: number of edits that frames have taken.
    [[nodiscard]] std::uint64_t taken() const noexcept
    {
        return head_.load(std::memory_order_relaxed); // A number for display; orders nothing.
    }

private:
    struct Cell
    {
        ModelId model;
        std::uint32_t revision{0};
        std::uint32_t removed_count{0};
        std::uint32_t added_count{0};
        Aabb removed_m;
        std::array<FaceId, kMaxEditFaces> removed{};
        std::array<AddedFace, kMaxEditFaces> added{};
    };

    std::vector<Cell> cells_;
    std::array<SurfaceEdit, kEditsPerFrame> views_{};
    std::size_t shown_{0}; ///< Number of edits from the last edits().
    alignas(64) std::atomic<std::uint64_t> head_{0};
    /// Number of the model of the last refused edit, plus 1; 0: none. Orders nothing.
    std::atomic<std::uint32_t> refused_{0};
    alignas(64) std::atomic<std::uint64_t> tail_{0};
};

} // namespace tactus
