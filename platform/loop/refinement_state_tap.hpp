// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/run_statistics.hpp"
#include "platform/machine/time.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/similarity.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"
#include "rt_core/records/region_ranking.hpp"
#include "rt_core/records/safety.hpp"
#include "rt_core/records/tool_force.hpp"
#include "rt_core/spm/page_pool.hpp"
#include "transport/refinement_state.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus
{

class Frame;
class ObjectTable;

} // namespace tactus

namespace tactus::hrtc
{

/// Copy of one frame's refinement state. Models have the controller's numbers.
struct RefinementStateCopy
{
    struct Tool
    {
        SafetyState state{SafetyState::reset};
        ForceOff causes{ForceOff::none};
    };
    /// Statistics of one timed span (kFrontTimes) over all frames so far.
    struct Times
    {
        std::uint64_t count{0};
        double mean_ns{0.0};
        Duration max;
    };

    using AllTimes = std::array<Times, kFrontTimes>;

    std::uint64_t frame{0};
    AllTimes times{};
    Budgets budgets;
    StaticVector<Tool, kMaxTools> tools;
    StaticVector<RefinementStateRegion, kMaxStateRegions> regions; ///< Regions of highest priority.
    std::uint32_t regions_left_out{0};                             ///< Number of other regions.
    /// First page slots of the pool.
    std::vector<ShownPage> slots;
    std::uint32_t slots_left_out{0}; ///< Number of slots that `slots` lacks.
};

/// Copies the refinement state of at most one frame in kFrames for viewers. The copy belongs to one
/// thread at a time: the haptic thread fills it; the transport thread reads it and gives it back.
/// Neither ever waits.
class RefinementStateTap
{
public:
    /// Least number of frames between copies.
    static constexpr std::uint64_t kFrames = 100;

    /// Call it before the loop. Copies the pool's first slots, `most_slots` at most, 16 bytes each.
    /// The pool must outlive the tap and have no other tap.
    explicit RefinementStateTap(PagePool& pages, std::size_t most_slots = kMaxStatePages);

    struct ShownFront
    {
        std::uint64_t frame; ///< Number of the frame, from 0.
        std::span<const RankedRegion> regions;
        std::span<const ToolForce> forces; ///< Forces, one a tool.
        const Budgets& budgets;
    };

    /// Haptic thread, after a frame: makes a copy if the frame's number is a multiple of kFrames
    /// and the last copy was given back. A copy takes 16 bytes of each page slot that has changed
    /// since the last one, and kMaxStateRegions regions. Allocates nothing.
    void show(const ShownFront& shown, const RunStatistics& statistics) noexcept
    {
        // Pairs with the release in give_back().
        if (shown.frame % kFrames == 0 && !is_out_.load(std::memory_order_acquire))
        {
            copy(shown, statistics);
            is_out_.store(true, std::memory_order_release); // Pairs with the acquire in take().
        }
    }

    /// Transport thread: the copy, valid until give_back(); null if there is none.
    [[nodiscard]] const RefinementStateCopy* take() const noexcept
    {
        // Pairs with the release in show().
        return is_out_.load(std::memory_order_acquire) ? &copy_ : nullptr;
    }
    void give_back() noexcept
    {
        is_out_.store(false, std::memory_order_release); // Pairs with the acquire in show().
    }

private:
    void copy(const ShownFront& shown, const RunStatistics& statistics) noexcept;
    void copy_times(const RunStatistics& statistics) noexcept;
    void copy_regions(std::span<const RankedRegion> regions) noexcept;

    PagePool& pages_;
    std::atomic<bool> is_out_{false};
    RefinementStateCopy copy_;
};

} // namespace tactus::hrtc
