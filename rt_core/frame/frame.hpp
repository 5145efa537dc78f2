// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/frame/frame_parts.hpp"
#include "rt_core/frame/frame_setup.hpp"
#include "rt_core/frame/loading.hpp"
#include "rt_core/frame/narrow_phase.hpp"
#include "rt_core/frame/neighbours.hpp"
#include "rt_core/frame/pair_shedding.hpp"
#include "rt_core/frame/refinement.hpp"
#include "rt_core/frame/resting.hpp"
#include "rt_core/frame/scene_changes.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace tactus
{

/// The controller's frame: all stages in order, every period, on the haptic thread.
///
/// Takes all its memory from the arena at start. `run` does not allocate, lock, call the system,
/// log or throw and reads no clock; every loop in it is bounded by the budgets and by limits.hpp.
/// The same inputs, including arrivals, give the same bits.
class Frame
{
public:
    /// Reads headers and base meshes and lays out all pools. Not on the haptic thread. A refusal
    /// changes nothing, except base_refused, which leaves no frame and uses up the memory. The
    /// arena's memory must outlive the frame.
    [[nodiscard]] static Result<Done, FrameRefusal> start(std::optional<Frame>& frame, Arena& arena,
                                                          const FrameSetup& setup) noexcept;
    /// Bytes that start() takes from the arena, for headers that parse (asserted).
    [[nodiscard]] static std::size_t required_bytes(const FrameSetup& setup) noexcept;

    Frame(const Frame&) = delete;
    Frame& operator=(const Frame&) = delete;
    Frame(Frame&&) = delete;
    Frame& operator=(Frame&&) = delete;
    ~Frame() = default;

    /// Runs one period, on the haptic thread. A change that can't be made is refused, counted by
    /// its reason, and changes nothing. The output is valid until the next run.
    [[nodiscard]] FrameOutput run(const FrameInput& input,
                                  StageMark mark = {}) noexcept TACTUS_NONBLOCKING;

    /// Warms caches: repeats the last frame's queries, into scratch memory, with the same machine
    /// code. Called in the wait before the deadline. No effect on any result.
    void warm_caches() noexcept TACTUS_NONBLOCKING;

    /// Tool, in set-up order; it must exist, which is not checked. The same holds for models.
    [[nodiscard]] const Tool& tool(std::uint32_t index) const noexcept
    {
        return parts_.tools[index];
    }
    /// The scene's objects by their numbers, after the last frame.
    [[nodiscard]] const ObjectTable& objects() const noexcept { return parts_.objects; }
    /// Regions that tools may touch, highest priority first: the last ones searched for pages.
    [[nodiscard]] std::span<const RankedRegion> regions() const noexcept
    {
        return loading_.regions();
    }
    /// A model with its inbox, linker and slots, which are the transport thread's.
    [[nodiscard]] Model& model(ModelId id) noexcept { return parts_.models[id]; }
    [[nodiscard]] const Model& model(ModelId id) const noexcept { return parts_.models[id]; }
    [[nodiscard]] std::uint32_t model_count() const noexcept { return parts_.models.size(); }
    /// Shared data of the models; slots, queues and links are used by the transport thread, too.
    [[nodiscard]] ModelPools& pools() noexcept { return parts_.pools; }

    struct PassKey
    {
    private:
        friend class Frame;
        PassKey() = default;
    };
    Frame(PassKey key, Arena& arena, const FrameSetup& setup) noexcept;

private:
    void begin(const FrameInput& input) noexcept;
    void place_pairs() noexcept;
    [[nodiscard]] FrameOutput output() const noexcept;

    FrameParts parts_;
    FrameAccount account_;
    SceneChanges changes_;
    Neighbours neighbours_;
    PairShedding shedding_;
    Loading loading_;
    Refinement refinement_;
    Resting resting_;
    NarrowPhase narrow_;
};

} // namespace tactus
