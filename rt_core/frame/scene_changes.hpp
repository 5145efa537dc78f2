// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/records/scene_change.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace tactus
{

class Neighbours;
struct FrameParts;
struct FrameSetup;
struct SceneOutput;

/// Applies the changes of the scene before any stage, so that the whole frame sees one scene. A
/// change that can't be made is refused and changes nothing. Haptic thread. Cost: linear in the
/// changes; one costs about 0.05 us with all consequences in a frame (ObjectTable).
class SceneChanges
{
public:
    SceneChanges(Arena& arena, const FrameSetup& setup) noexcept;

    /// Places the objects with which a frame starts; their models must exist.
    static void place_first(const FrameSetup& setup, FrameParts& parts,
                            Neighbours& neighbours) noexcept;
    /// Applies the changes in order, at most kMaxSceneChanges, and counts refused ones by their
    /// reasons.
    void make(std::span<const SceneChange> changes, FrameParts& parts, Neighbours& neighbours,
              SceneOutput& scene) const noexcept TACTUS_NONBLOCKING;

private:
    using Refusal = std::optional<ChangeRefusal>;

    [[nodiscard]] Refusal try_change_object(const SceneChange& change, FrameParts& parts,
                                            Neighbours& neighbours) const noexcept;
    [[nodiscard]] static Refusal try_change_tool(const SceneChange& change, FrameParts& parts,
                                                 Neighbours& neighbours) noexcept;

    std::span<bool>
        is_shown_; ///< True for each model that objects may show; false for models of mesh tools.
};

} // namespace tactus
