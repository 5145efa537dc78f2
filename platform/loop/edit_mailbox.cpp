// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/edit_mailbox.hpp"

#include "rt_core/base/assert.hpp"

#include <algorithm>

namespace tactus
{

bool EditMailbox::try_put(ModelId model, const EditContent& edit) noexcept
{
    TACTUS_ASSERT(edit.removed.size() <= kMaxEditFaces);
    TACTUS_ASSERT(edit.added.size() <= kMaxEditFaces);
    const std::uint64_t tail = tail_.load(std::memory_order_relaxed); // No other writer.
    // Pairs with the release in done(): the cell's old edit has been read.
    if (tail - head_.load(std::memory_order_acquire) == kEdits)
    {
        return false;
    }
    Cell& cell = cells_[static_cast<std::size_t>(tail % kEdits)];
    cell.model = model;
    cell.revision = edit.revision;
    cell.removed_m = edit.removed_m;
    cell.removed_count = static_cast<std::uint32_t>(edit.removed.size());
    cell.added_count = static_cast<std::uint32_t>(edit.added.size());
    std::ranges::copy(edit.removed, cell.removed.begin());
    std::ranges::copy(edit.added, cell.added.begin());
    tail_.store(tail + 1, std::memory_order_release); // Pairs with the acquire in edits().
    return true;
}

std::span<const SurfaceEdit> EditMailbox::edits() noexcept
{
    const std::uint64_t head = head_.load(std::memory_order_relaxed); // No other writer.
    // Pairs with the release in try_put(): the cells have been written.
    const std::uint64_t waiting = tail_.load(std::memory_order_acquire) - head;
    shown_ = static_cast<std::size_t>(std::min<std::uint64_t>(waiting, views_.size()));
    for (std::size_t i = 0; i < shown_; ++i)
    {
        const Cell& cell = cells_[static_cast<std::size_t>((head + i) % kEdits)];
        views_[i] = {cell.model, cell.revision, std::span(cell.removed).first(cell.removed_count),
                     std::span(cell.added).first(cell.added_count), cell.removed_m};
    }
    return std::span(views_).first(shown_);
}

void EditMailbox::done(std::span<const ModelOutput> models) noexcept
{
    for (const SurfaceEdit& edit : std::span(views_).first(shown_))
    {
        const std::uint32_t model = edit.model.value;
        if (model >= models.size() || models[model].edit_revision < edit.revision)
        {
            refused_.store(model + 1, std::memory_order_relaxed);
        }
    }
    if (shown_ > 0)
    {
        const std::uint64_t head = head_.load(std::memory_order_relaxed);
        head_.store(head + shown_,
                    std::memory_order_release); // Pairs with the acquire in try_put().
        shown_ = 0;
    }
}

std::optional<ModelId> EditMailbox::take_refused_model() noexcept
{
    const std::uint32_t refused = refused_.exchange(0, std::memory_order_relaxed);
    return refused > 0 ? std::optional(ModelId{refused - 1}) : std::nullopt;
}

} // namespace tactus
