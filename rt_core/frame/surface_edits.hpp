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
    /// reasons. The spans stay valid until tell_pairs().
    void make(std::span<const SurfaceEdit> edits, FrameParts& parts,
              FrameAccount& account) noexcept TACTUS_NONBLOCKING;
    /// Makes the pairs of the edited models forget the former surface, once they are placed.
    void tell_pairs(FrameParts& parts) noexcept TACTUS_NONBLOCKING;

private:
    StaticVector<SurfaceEdit, kMaxEditsPerFrame> made_; ///< Edits of this frame that were made.
};

} // namespace tactus
