// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/frame/frame_setup.hpp"
#include "rt_core/frame/pair.hpp"
#include "rt_core/frame/tool.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace tactus
{

/// The controller's frame: all stages in order, every period, on the haptic thread.
///
/// Takes all its memory from the arena at start. `run` makes no allocation, lock, system call,
/// log or exception, reads no clock, and every loop in it is bounded by the budgets and by
/// limits.hpp. The same inputs, arrivals included, give the same bits.
class Frame
{
public:
    /// Reads headers and base meshes and lays out all pools. Not on the haptic thread.
    [[nodiscard]] static Result<Done, FrameRefusal> start(std::optional<Frame>& frame, Arena& arena,
                                                          const FrameSetup& setup) noexcept;
    /// Bytes that start() takes from the arena for headers that parse.
    [[nodiscard]] static std::size_t required_bytes(const FrameSetup& setup) noexcept;

    Frame(const Frame&) = delete;
    Frame& operator=(const Frame&) = delete;
    Frame(Frame&&) = delete;
    Frame& operator=(Frame&&) = delete;
    ~Frame() = default;

    /// One period, with an entry for each tool and object in set-up order. Poses place the source
    /// meshes: a default pose leaves a model where its source stood. The output is valid until the
    /// next run.
    [[nodiscard]] FrameOutput run(std::span<const ToolState> tools,
                                  std::span<const ObjectPose> poses, const Budgets& budgets,
                                  StageMark mark) noexcept TACTUS_NONBLOCKING;

    /// Runs last frame's queries again, into scratch memory, with the same machine code: called in
    /// the wait before the deadline it brings code and data back into the caches. No effect on any
    /// result.
    void rehearse() noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] const Tool& tool(std::uint32_t index) const noexcept { return tools_[index]; }
    /// The transport thread's parts of a model: its inbox, linker and slots.
    [[nodiscard]] Model& model(ModelId id) noexcept { return *models_[id.value]; }
    [[nodiscard]] const Model& model(ModelId id) const noexcept { return *models_[id.value]; }
    [[nodiscard]] std::uint32_t model_count() const noexcept { return model_count_; }

    struct PassKey
    {
    private:
        friend class Frame;
        PassKey() = default;
    };
    Frame(PassKey key, Arena& arena, const FrameSetup& setup) noexcept;

private:
    [[nodiscard]] bool try_take_models(Arena& arena, const FrameSetup& setup) noexcept;
    void take_tools(Arena& arena, const FrameSetup& setup) noexcept;
    void take_pairs(Arena& arena, const FrameSetup& setup) noexcept;

    void begin(std::span<const ToolState> tools, std::span<const ObjectPose> poses) noexcept;
    void load(const Budgets& budgets) noexcept;
    void refine(const Budgets& budgets) noexcept;
    void refit() noexcept;
    void respond() noexcept;
    [[nodiscard]] FrameOutput report() noexcept;

    PairRules rules_;
    StaticVector<ObjectSpec, kMaxObjects> objects_;
    std::array<std::optional<Model>, kMaxModels> models_;
    std::uint32_t model_count_{0};
    std::span<Tool> tools_;
    std::span<Pair> pairs_; ///< Tool by tool, in each the objects in order.
    bool has_meshes_{false};
    LocalSurface* rehearsed_{nullptr};

    std::uint32_t frame_{ChunkCache::kFirstFrame};
    bool has_poses_{false};
    std::array<ObjectPose, kMaxObjects> poses_{}; ///< Of the models' frames, in this frame.
    std::array<ObjectPose, kMaxObjects> last_poses_{};
    RefineQuestions questions_; ///< About the model that is being refined.
    Budgets budgets_;           ///< The last frame's.

    std::array<ToolOutput, kMaxTools> tool_outputs_{};
    std::array<PairOutput, kMaxPairs> pair_outputs_{};
    std::array<ModelOutput, kMaxModels> model_outputs_{};
    std::array<DoorTake, kMaxModels> door_takes_{};
    WorkCounters work_;
    FrameFault faults_{FrameFault::none};
};

} // namespace tactus
