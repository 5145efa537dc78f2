// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/frame/pair.hpp"
#include "rt_core/limits.hpp"

#include <array>
#include <cstdint>

namespace tactus
{

struct FrameAccount;
struct FrameParts;
struct FrameSetup;

/// Query stage of a frame: finds each pair's distance, and the surface that its tool may touch.
///
/// Pairs are served by priority, and later pairs share what is left of the frame's traversals and
/// memory for triangles. Pairs of mesh tools use neither: they have an allowance of their own
/// (kMeshBudgetFactor). Haptic thread. Cost: linear in the nodes and triangles near each tool;
/// besides mesh tools at most Budgets::nodes and `triangles` a pair, and kFrameWalks times as many
/// in all.
class NarrowPhase
{
public:
    /// Takes memory from the arena for the triangles of the set-up's pairs.
    NarrowPhase(Arena& arena, const FrameSetup& setup) noexcept;

    /// Runs the queries of all tools except resting ones.
    void run(FrameParts& parts, FrameAccount& account) noexcept TACTUS_NONBLOCKING;

    /// Repeats the queries of one tool from its new place. False if one of them lacks a whole
    /// budget, as its answer could then prove less than the last one.
    [[nodiscard]] bool try_again(FrameParts& parts, std::uint32_t tool,
                                 FrameAccount& account) noexcept TACTUS_NONBLOCKING;

    /// Does the work of Frame::warm_caches(), in the memory of the last frame's surfaces, which are
    /// not needed any more.
    void warm_caches(const FrameParts& parts,
                     const FrameAccount& account) const noexcept TACTUS_NONBLOCKING;

private:
    /// Nodes visited and triangles tested by queries.
    struct Walked
    {
        std::uint32_t nodes{0};
        std::uint32_t triangles{0};
    };
    [[nodiscard]] static Walked walked_in(const WorkCounters& work) noexcept;
    [[nodiscard]] Budgets left_of(const Budgets& budgets) const noexcept;
    void count(const Walked& before, const WorkCounters& now) noexcept;

    SurfaceRoom room_;
    SurfaceRoom room_left_; ///< Room left after the queries of this frame.
    Walked walked_;         ///< Nodes and triangles of this frame's queries.
    /// Work of each tool's queries in this frame, in instructions.
    std::array<std::uint32_t, kMaxTools> query_work_{};
};

} // namespace tactus
