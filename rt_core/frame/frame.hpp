// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/frame/awake_pairs.hpp"
#include "rt_core/frame/frame_setup.hpp"
#include "rt_core/frame/model_life.hpp"
#include "rt_core/frame/model_set.hpp"
#include "rt_core/frame/pair_shedding.hpp"
#include "rt_core/frame/refinement.hpp"
#include "rt_core/frame/tool.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"
#include "rt_core/scene/broad_phase.hpp"
#include "rt_core/scene/object_table.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

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
    /// Reads headers and base meshes and lays out all pools. Not on the haptic thread. Refused with
    /// nothing changed, but base_refused: then there is no frame, and the memory is used up. The
    /// arena's memory outlives the frame.
    [[nodiscard]] static Result<Done, FrameRefusal> start(std::optional<Frame>& frame, Arena& arena,
                                                          const FrameSetup& setup) noexcept;
    /// Bytes that start() takes from the arena for headers that parse (asserted).
    [[nodiscard]] static std::size_t required_bytes(const FrameSetup& setup) noexcept;

    Frame(const Frame&) = delete;
    Frame& operator=(const Frame&) = delete;
    Frame(Frame&&) = delete;
    Frame& operator=(Frame&&) = delete;
    ~Frame() = default;

    /// One period, on the haptic thread. A change that can't be made is refused, counted by its
    /// reason, and changes nothing. The output is valid until the next run.
    [[nodiscard]] FrameOutput run(const FrameInput& input,
                                  StageMark mark = {}) noexcept TACTUS_NONBLOCKING;

    /// Runs last frame's queries again, into scratch memory, with the same machine code: called in
    /// the wait before the deadline it brings code and data back into the caches. No effect on any
    /// result.
    void rehearse() noexcept TACTUS_NONBLOCKING;

    /// In set-up order; there must be such a tool, which nothing checks. Likewise with models.
    [[nodiscard]] const Tool& tool(std::uint32_t index) const noexcept { return tools_[index]; }
    /// The scene's objects by their numbers, as the last frame left them.
    [[nodiscard]] const ObjectTable& objects() const noexcept { return objects_; }
    /// What tools may touch, most urgent first: where pages were looked for last.
    [[nodiscard]] std::span<const RankedRegion> regions() const noexcept { return ranking_.view(); }
    /// The transport thread's parts of a model: its inbox, linker and slots.
    [[nodiscard]] Model& model(ModelId id) noexcept { return models_[id]; }
    [[nodiscard]] const Model& model(ModelId id) const noexcept { return models_[id]; }
    [[nodiscard]] std::uint32_t model_count() const noexcept { return models_.size(); }
    /// What the models share; slots, door and links are for the transport thread, too.
    [[nodiscard]] ModelPools& pools() noexcept { return pools_; }

    struct PassKey
    {
    private:
        friend class Frame;
        PassKey() = default;
    };
    Frame(PassKey key, Arena& arena, const FrameSetup& setup) noexcept;

private:
    /// Metres, then who it is.
    using Nearness = std::pair<double, std::uint32_t>;
    /// Farther than anything.
    static constexpr Nearness kNobody{kInfinity, 0xFFFF'FFFFU};

    [[nodiscard]] bool try_take_models(Arena& arena, const FrameSetup& setup) noexcept;
    void take_tools(Arena& arena, const FrameSetup& setup) noexcept;
    void take_pairs(Arena& arena, const FrameSetup& setup, std::uint32_t count) noexcept;
    void take_objects(const FrameSetup& setup) noexcept;

    void change_scene(std::span<const SceneChange> changes) noexcept;
    [[nodiscard]] std::optional<ChangeRefusal> try_change(const SceneChange& change) noexcept;
    [[nodiscard]] std::optional<ChangeRefusal> try_change_tool(const SceneChange& change) noexcept;
    void place(std::uint32_t object) noexcept;
    void look_for_leap(std::uint32_t object, const ObjectPose& before) noexcept;
    void begin(std::span<const ToolState> tools) noexcept;
    void find_neighbours() noexcept;
    void wake_models() noexcept;
    [[nodiscard]] Nearness first_left_out() const noexcept;
    [[nodiscard]] Nearness nearness(std::uint32_t tool, std::uint32_t object) const noexcept;
    void pair_up(const Nearness& first_out) noexcept;
    void find_clearances(const Nearness& first_out) noexcept;
    [[nodiscard]] bool begins_apart(std::uint32_t tool, std::uint32_t object) const noexcept;
    void begin_pair(std::uint32_t tool, std::uint32_t object) noexcept;
    void end_pair(Pair& pair) noexcept;
    void load(const Budgets& budgets) noexcept;
    void refine(const Budgets& budgets) noexcept;
    void refit() noexcept;
    void find_resting() noexcept;
    [[nodiscard]] bool try_rest(const FrameInput& input) noexcept;
    void query() noexcept;
    void respond() noexcept;
    [[nodiscard]] ToolOutput respond(std::uint32_t tool) noexcept;
    [[nodiscard]] ToolOutput step(std::uint32_t tool, double clear_m,
                                  std::uint32_t& planes) noexcept;
    [[nodiscard]] bool try_query_again(std::uint32_t tool) noexcept;
    [[nodiscard]] Budgets walks_left() const noexcept;
    void report() noexcept;
    [[nodiscard]] FrameOutput output() const noexcept;

    PairRules rules_;
    ObjectTable objects_;
    BroadPhase broad_;
    ModelPools pools_;
    ModelSet models_;
    std::span<bool> is_shown_; ///< By model: whether objects may show it.
    std::span<Tool> tools_;
    RigidProxy::Planes* planes_{nullptr}; ///< Of all tools that are held as bodies.
    /// A tool beside its body.
    struct Presence
    {
        bool is_here{true};
        double clear_m{0.0};    ///< ToolOutput::clear_m, or below zero where nothing is known yet.
        double leap_m{0.0};     ///< Farthest way in this frame of what it has no pair of.
        bool is_crowded{false}; ///< In this frame it asks for more than that.
        bool rests{false};      ///< In this frame it answers as in the last one.
    };
    std::array<Presence, kMaxTools> presences_{};
    AwakePairs pairs_;
    std::uint32_t paired_lists_{0}; ///< BroadPhase::lists() that all are pairs of; 0: not all.
    SurfaceRoom room_;
    SurfaceRoom room_left_; ///< After the queries of this frame.
    Budgets walked_;        ///< Nodes and triangles of them; the rest is not of use.

    std::uint32_t frame_{ChunkCache::kFirstFrame};
    Budgets budgets_;       ///< The last frame's.
    RegionRanking ranking_; ///< The last one that was made.
    Refinement refinement_;
    PairShedding shedding_;
    ModelLife life_;
    bool has_guests_{false};

    std::array<ToolOutput, kMaxTools> tool_outputs_{};
    std::array<PairOutput, kMaxPairs> pair_outputs_{};
    std::span<ModelOutput> model_outputs_;
    bool may_rest_{false}; ///< The last frame ended with everything at rest.
    WorkCounters work_;
    SceneOutput scene_;
    FrameFault faults_{FrameFault::none};
};

} // namespace tactus
