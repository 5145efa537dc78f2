// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/frame/frame_parts.hpp"
#include "rt_core/records/surface_edit.hpp"

#include <span>

namespace tactus
{

/// Applies the edits of models' surfaces before any stage, so that the whole frame sees one
/// surface. A refused edit changes nothing. Haptic thread.
class SurfaceEdits
{
public:
    /// Applies the edits in order, at most kMaxEditsPerFrame, and counts refused ones by their
    /// reasons. Pairs of the edited models forget the former surface. The spans stay valid until
    /// tell_pairs().
    void make(std::span<const SurfaceEdit> edits, FrameParts& parts,
              FrameAccount& account) noexcept TACTUS_NONBLOCKING;
    /// Lets the tools go that added faces entered, once the pairs are placed.
    void tell_pairs(FrameParts& parts) noexcept TACTUS_NONBLOCKING
    {
        if (!made_.empty())
        {
            tell_pairs_of_edits(parts);
        }
    }

private:
    void tell_pairs_of_edits(FrameParts& parts) noexcept TACTUS_NONBLOCKING;

    StaticVector<SurfaceEdit, kMaxEditsPerFrame> made_; ///< Edits of this frame that were made.
};

} // namespace tactus
