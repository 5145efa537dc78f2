// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/work_budget.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

// Usable on any thread: plain values and pure functions. No call waits or allocates.
namespace tactus
{

/// Shortcuts that avoid work; FrameVariant turns each off.
enum class Skip : std::uint8_t
{
    /// Objects of a scene that one comparison proved to be far from a tool.
    objects,
    /// Models with no region's sphere near any of their boxes: nothing is requested.
    models,
    /// Regions whose spheres were inside those of a recent search of index pages.
    searches,
    /// Pairs at rest, proven out of reach: no query.
    pairs,
    /// Regions whose certificate still holds: no face is checked.
    regions,
    /// Queries that began where the last query of the pair ended.
    starts,
    /// Boxes of AB-Trees that were not refitted, as nothing in them changed.
    boxes,
    /// Tools at rest among objects at rest: they keep the last answers and forces.
    tools,
    /// Whole frames: all tools at rest, and all models resident as a whole.
    frames,
};
inline constexpr std::size_t kSkips = 9;
/// Names of the shortcuts, in the order of Skip.
inline constexpr std::array<const char*, kSkips> kSkipNames{
    "objects", "models", "searches", "pairs", "regions", "starts", "boxes", "tools", "frames"};

/// Number of times that a frame took each shortcut.
class SkipCounters
{
public:
    void add(Skip skip, std::uint32_t times = 1) noexcept
    {
        times_[static_cast<std::size_t>(skip)] += times;
    }
    [[nodiscard]] const std::array<std::uint32_t, kSkips>& times() const noexcept { return times_; }
    SkipCounters& operator+=(const SkipCounters& other) noexcept
    {
        for (std::size_t i = 0; i < kSkips; ++i)
        {
            times_[i] += other.times_[i];
        }
        return *this;
    }

private:
    std::array<std::uint32_t, kSkips> times_{};
};

/// Work of a frame, counted in the units of its budgets: sums over models and pairs.
struct WorkCounters
{
    std::uint32_t splits{0};
    std::uint32_t merges{0};
    std::uint32_t scanned{0};
    std::uint32_t nodes_visited{0};
    std::uint32_t triangles_tested{0};
    std::uint32_t planes_looked_at{0};
    std::uint32_t pages_adopted{0};
    std::uint32_t requests{0};
    std::uint32_t regions_searched{0};
    std::uint32_t nodes_refitted{0};
    std::uint32_t blocks_refitted{0};
    std::uint32_t evictions{0};
    std::uint32_t cache_hits{0};   ///< Wanted chunks found resident.
    std::uint32_t cache_misses{0}; ///< Wanted chunks absent and requested.
    SkipCounters skipped;
    WorkBudget budget; ///< Total cost of the frame's work, and its limit.

    WorkCounters& operator+=(const WorkCounters& other) noexcept
    {
        splits += other.splits;
        merges += other.merges;
        scanned += other.scanned;
        nodes_visited += other.nodes_visited;
        triangles_tested += other.triangles_tested;
        planes_looked_at += other.planes_looked_at;
        pages_adopted += other.pages_adopted;
        requests += other.requests;
        regions_searched += other.regions_searched;
        nodes_refitted += other.nodes_refitted;
        blocks_refitted += other.blocks_refitted;
        evictions += other.evictions;
        cache_hits += other.cache_hits;
        cache_misses += other.cache_misses;
        skipped += other.skipped;
        budget.spend(other.budget.used());
        return *this;
    }
};

/// Degradations of a frame. Each flag names the limit to raise.
enum class FrameFault : std::uint32_t
{
    none = 0,
    split_budget_spent = 1U << 0U, ///< Faces in reach stay coarse. Raise `splits` or `work`.
    forest_full = 1U << 1U, ///< A split was refused for lack of faces. Give more `--pool-mib`.
    tree_full = 1U << 2U,   ///< No block or node for a face. Give more `--pool-mib`.
    chunk_late = 1U << 3U,  ///< A needed record isn't resident. Look further ahead.
    cache_full = 1U << 4U,  ///< All pages are in use. Give more `--cache-mib`.
    node_budget_spent = 1U << 5U,  ///< A walk was cut short. Raise `work`, `nodes`, `triangles`.
    surface_truncated = 1U << 6U,  ///< More triangles in reach than kMaxLocalTriangles.
    model_inconsistent = 1U << 7U, ///< A record contradicts the mesh: rebuild the model.
    tool_invalid = 1U << 8U,       ///< A device sample was not usable.
    proxy_halted = 1U << 9U,       ///< Surface round a proxy is not certified; its force fades.
    tool_stuck = 1U << 10U,        ///< The device's time does not advance; the force fades.
    /// A goal moved faster than any user; no force until the goal is back at the proxy.
    tool_jumped = 1U << 11U,
    /// Objects leave a proxy no room, or an object passes over it.
    proxy_over_constrained = 1U << 12U,
    refine_heap_full = 1U << 13U,  ///< More coarse faces in reach than kRefineHeap.
    held_records_full = 1U << 14U, ///< More records of open closures than kMaxHeldRecords.
    ranking_full = 1U << 15U,      ///< More regions at tools than kMaxRankedRegions.
    /// Some contacts of a tool did not fit (kMaxContacts and other limits).
    tool_over_capacity = 1U << 16U,
    /// Pair without loading or refinement, for one of higher priority. More `--pool-mib`.
    pair_shed = 1U << 17U,
    /// A tool has too many objects near it and goes no farther than its proven clearance. See
    /// kMaxPairs.
    scene_over_capacity = 1U << 18U,
    /// A touched object was removed or jumped; the tool's force fades.
    object_lost = 1U << 19U,
    /// A proxy stopped early, as its checks were used up. Raise `planes` or `work`.
    plane_budget_spent = 1U << 20U,
};
inline constexpr std::size_t kFrameFaults = 21;
/// Names of the flags, in the order of FrameFault's bits.
inline constexpr std::array<const char*, kFrameFaults> kFrameFaultNames{"split_budget_spent",
                                                                        "forest_full",
                                                                        "tree_full",
                                                                        "chunk_late",
                                                                        "cache_full",
                                                                        "node_budget_spent",
                                                                        "surface_truncated",
                                                                        "model_inconsistent",
                                                                        "tool_invalid",
                                                                        "proxy_halted",
                                                                        "tool_stuck",
                                                                        "tool_jumped",
                                                                        "proxy_over_constrained",
                                                                        "refine_heap_full",
                                                                        "held_records_full",
                                                                        "ranking_full",
                                                                        "tool_over_capacity",
                                                                        "pair_shed",
                                                                        "scene_over_capacity",
                                                                        "object_lost",
                                                                        "plane_budget_spent"};

[[nodiscard]] constexpr FrameFault operator|(FrameFault a, FrameFault b) noexcept
{
    return static_cast<FrameFault>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
[[nodiscard]] constexpr FrameFault operator&(FrameFault a, FrameFault b) noexcept
{
    return static_cast<FrameFault>(static_cast<std::uint32_t>(a) & static_cast<std::uint32_t>(b));
}
constexpr FrameFault& operator|=(FrameFault& a, FrameFault b) noexcept
{
    return a = a | b;
}
[[nodiscard]] constexpr bool has_fault(FrameFault set, FrameFault one) noexcept
{
    return (static_cast<std::uint32_t>(set) & static_cast<std::uint32_t>(one)) != 0;
}

} // namespace tactus
