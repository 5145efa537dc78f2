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
#include "rt_core/frame/surface_edits.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace tactus
{

/// Frame of the controller: all stages in order, once a period, on the haptic thread.
///
/// Takes all its memory from the arena at start. `run` does not allocate, lock, call the system,
/// log or throw and reads no clock; every loop in it is bounded by the budgets and by limits.hpp.
/// The same inputs, including arrivals, give the same bits.
class Frame
{
public:
    /// Reads headers and base meshes and lays out all pools; not on the haptic thread. The arena's
    /// memory must outlive the frame. If refused, nothing has changed, except for base_refused,
    /// which uses up the memory.
    [[nodiscard]] static Result<Done, FrameRefusal> start(std::optional<Frame>& frame, Arena& arena,
                                                          const FrameSetup& setup) noexcept;
    /// Bytes that start() takes from the arena, for headers that parse (asserted).
    [[nodiscard]] static std::size_t required_bytes(const FrameSetup& setup) noexcept;

    Frame(const Frame&) = delete;
    Frame& operator=(const Frame&) = delete;
    Frame(Frame&&) = delete;
    Frame& operator=(Frame&&) = delete;
    ~Frame() = default;

    /// Runs one period, on the haptic thread. A change of the scene that can't be made is refused,
    /// counted by its reason, and changes nothing. The output is valid until the next run.
    [[nodiscard]] FrameOutput run(const FrameInput& input,
                                  StageMark mark = {}) noexcept TACTUS_NONBLOCKING;

    /// Warms the processor's caches: repeats the last frame's queries into scratch memory. Called
    /// in the wait before the deadline. No effect on any result.
    void warm_caches() noexcept TACTUS_NONBLOCKING;

    /// Tool by its index in set-up order; it must exist, which is not checked. The same holds for
    /// model().
    [[nodiscard]] const Tool& tool(std::uint32_t index) const noexcept
    {
        return parts_.tools[index];
    }
    /// The scene's objects by their numbers, after the last frame.
    [[nodiscard]] const ObjectTable& objects() const noexcept { return parts_.objects; }
    /// Regions that tools may touch, highest priority first, as of the last run that ranked them.
    [[nodiscard]] std::span<const RankedRegion> regions() const noexcept
    {
        return loading_.regions();
    }
    /// Model by its id. Its linker and slots are for the transport thread.
    [[nodiscard]] Model& model(ModelId id) noexcept { return parts_.models[id]; }
    [[nodiscard]] const Model& model(ModelId id) const noexcept { return parts_.models[id]; }
    [[nodiscard]] std::uint32_t model_count() const noexcept { return parts_.models.size(); }
    /// Shared pools of the models; the transport thread uses their slots, queues and links, too.
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
    SurfaceEdits edits_;
    Neighbours neighbours_;
    PairShedding shedding_;
    Loading loading_;
    Refinement refinement_;
    Resting resting_;
    NarrowPhase narrow_;
};

} // namespace tactus
