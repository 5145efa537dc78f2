// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/surface_edits.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/frame/frame_parts.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

std::optional<EditRefusal> try_edit(const SurfaceEdit& edit, FrameParts& parts,
                                    FrameAccount& account) noexcept
{
    if (edit.model.value >= parts.models.size())
    {
        return EditRefusal::unknown_model;
    }
    const auto refusal = parts.models[edit.model].edit(edit, account.work, account.faults);
    if (!refusal)
    {
        parts.models.keep_busy(edit.model);
        for (Pair* pair : parts.pairs.all())
        {
            if (pair->model() == edit.model)
            {
                pair->invalidate();
                parts.tools[pair->tool()].note_edit();
            }
        }
    }
    return refusal;
}

} // namespace

void SurfaceEdits::apply(std::span<const SurfaceEdit> edits, FrameParts& parts,
                         FrameAccount& account) noexcept
{
    TACTUS_ASSERT(applied_.empty()); // notify_pairs() of the last frame has emptied it.
    const std::size_t taken = std::min<std::size_t>(edits.size(), kMaxEditsPerFrame);
    for (const SurfaceEdit& edit : edits.first(taken))
    {
        if (const auto refusal = try_edit(edit, parts, account))
        {
            ++account.scene.edits_refused[static_cast<std::size_t>(*refusal)];
        }
        else
        {
            applied_.push_back(edit);
        }
    }
    account.scene.edits_refused[static_cast<std::size_t>(EditRefusal::too_many)] +=
        static_cast<std::uint32_t>(edits.size() - taken);
}

void SurfaceEdits::notify_pairs_of_applied(FrameParts& parts) noexcept
{
    for (const SurfaceEdit& edit : applied_)
    {
        for (Pair* pair : parts.pairs.all())
        {
            if (pair->model() == edit.model)
            {
                pair->ignore_if_entered(edit);
            }
        }
    }
    applied_.clear();
}

} // namespace tactus
