// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/frame/frame_parts.hpp"
#include "rt_core/limits.hpp"

#include <array>
#include <cstdint>

namespace tactus
{

/// A frame's query stage: each pair's distance and the surface that its tool may touch.
///
/// The most urgent pairs come first; the others have what these leave of the frame's walks and of
/// the room for triangles. Pairs of tools that are meshes have an allowance of their own
/// (kMeshBudgetFactor) and use none of it. Haptic thread.
class NarrowPhase
{
public:
    /// Room for the triangles of the set-up's pairs.
    NarrowPhase(Arena& arena, const FrameSetup& setup) noexcept;

    /// The queries of all tools but those that rest.
    void run(FrameParts& parts, FrameAccount& account) noexcept TACTUS_NONBLOCKING;

    /// The queries of one tool again, from where it has come to since. False where one of them has
    /// no whole budget left: its answer could prove less than the last one's.
    [[nodiscard]] bool try_again(FrameParts& parts, std::uint32_t tool,
                                 FrameAccount& account) noexcept TACTUS_NONBLOCKING;

    /// Frame::rehearse(), in the room of the last frame's surfaces, which are of no use any more.
    void rehearse(const FrameParts& parts,
                  const FrameAccount& account) const noexcept TACTUS_NONBLOCKING;

private:
    /// What the queries have visited and tested.
    struct Walked
    {
        std::uint32_t nodes{0};
        std::uint32_t triangles{0};
    };
    [[nodiscard]] static Walked walked_in(const WorkCounters& work) noexcept;
    [[nodiscard]] Budgets left_of(const Budgets& budgets) const noexcept;
    void count(const Walked& before, const WorkCounters& now) noexcept;

    SurfaceRoom room_;
    SurfaceRoom room_left_;                             ///< After the queries of this frame.
    Walked walked_;                                     ///< In this frame.
    std::array<std::uint32_t, kMaxTools> query_work_{}; ///< By tool: of its pairs in this frame.
};

} // namespace tactus
