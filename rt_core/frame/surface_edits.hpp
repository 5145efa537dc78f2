// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/surface_edit.hpp"

#include <span>

namespace tactus
{

struct FrameAccount;
struct FrameParts;

/// Applies the edits of models' surfaces before any stage, so that the whole frame sees one
/// surface. A refused edit changes nothing. Haptic thread. Cost: at most 100,000 instructions an
/// edit (kMaxEditFaces).
class SurfaceEdits
{
public:
    /// Applies the edits in order, at most kMaxEditsPerFrame, and counts refused ones by their
    /// reasons. Pairs of the edited models forget the former surface. The spans stay valid until
    /// notify_pairs().
    void apply(std::span<const SurfaceEdit> edits, FrameParts& parts,
               FrameAccount& account) noexcept TACTUS_NONBLOCKING;
    /// Makes tools that added faces entered ignore their objects, once the pairs are placed.
    void notify_pairs(FrameParts& parts) noexcept TACTUS_NONBLOCKING
    {
        if (!applied_.empty())
        {
            notify_pairs_of_applied(parts);
        }
    }

private:
    void notify_pairs_of_applied(FrameParts& parts) noexcept TACTUS_NONBLOCKING;

    /// Edits of this frame that were not refused.
    StaticVector<SurfaceEdit, kMaxEditsPerFrame> applied_;
};

} // namespace tactus
