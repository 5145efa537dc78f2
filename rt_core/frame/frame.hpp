// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/force/proxy.hpp"
#include "rt_core/force/rigid_proxy.hpp"
#include "rt_core/frame/mesh_pair.hpp"
#include "rt_core/frame/model.hpp"
#include "rt_core/frame/sample_watch.hpp"
#include "rt_core/predict/region_predictor.hpp"
#include "rt_core/query/surface_query.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"
#include "rt_core/records/frame_variant.hpp"
#include "rt_core/scene/scene.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace tactus
{

/// One model as it comes through the door: bytes of its header and base mesh, and its pool sizes.
struct ModelSource
{
    std::span<const std::byte> header; ///< Copied.
    std::span<const std::byte> base;   ///< Read once.
    ModelCapacities capacities;
};

/// What a frame is made of. `models[object.model]` must exist for every object, and for every tool
/// that is a mesh one that no object shows.
struct FrameSetup
{
    std::span<const ModelSource> models;
    std::span<const ObjectSpec> objects;
    std::span<const ToolSpec> tools;
    std::int64_t period_ns{1'000'000};
    std::int64_t pose_age_max_ns{100'000'000}; ///< Older poses make answers stale.
    /// A model that fits its pools is loaded and refined fully, once (static mode).
    bool static_when_it_fits{false};
    Prediction prediction{Prediction::automatic};
    FrameVariant variant;            ///< As it is: the frame that ships.
    const Kernels* kernels{nullptr}; ///< Null: best_kernels().
};

/// Why there is no frame.
enum class FrameRefusal : std::uint8_t
{
    too_many,         ///< More tools, objects or models than limits.hpp allows, or none.
    unknown_model,    ///< An object or a tool names a model that isn't there.
    shared_model,     ///< A tool names a model that an object shows.
    header_refused,   ///< A model's header did not pass its checks.
    base_refused,     ///< A model's base mesh did not pass its checks.
    memory_too_small, ///< The lent memory is less than required_bytes().
};

[[nodiscard]] const char* refusal_text(FrameRefusal refusal) noexcept;

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

    /// One period: `tools` and `poses` as many as at start. The output is valid until the next run.
    [[nodiscard]] FrameOutput run(std::span<const ToolState> tools,
                                  std::span<const ObjectPose> poses, const Budgets& budgets,
                                  StageMark mark) noexcept TACTUS_NONBLOCKING;

    /// Runs last frame's queries again, into scratch memory, with the same machine code: called in
    /// the wait before the deadline it brings code and data back into the caches. No effect on any
    /// result.
    void rehearse() noexcept TACTUS_NONBLOCKING;

    /// The places that a tool's proxy went by in the last frame, in straight lines, the first and
    /// the last included; until the next run. Empty for a tool without a proxy.
    [[nodiscard]] std::span<const Vec3> proxy_path_m(std::uint32_t tool) const noexcept
    {
        return proxies_[tool].path_m();
    }

    /// The transport thread's parts of a model: its inbox, linker and slots.
    [[nodiscard]] Model& model(ModelId id) noexcept { return *models_[id.value]; }
    [[nodiscard]] const Model& model(ModelId id) const noexcept { return *models_[id.value]; }
    [[nodiscard]] std::uint32_t model_count() const noexcept { return model_count_; }
    /// What is wrong with this tool's device after the last frame; the output's faults have those
    /// of all tools.
    [[nodiscard]] FrameFault sample_fault(std::uint32_t tool) const noexcept
    {
        return sample_watches_[tool].fault();
    }

    struct PassKey
    {
    private:
        friend class Frame;
        PassKey() = default;
    };
    Frame(PassKey key, Arena& arena, const FrameSetup& setup) noexcept;

private:
    static constexpr std::size_t kQuestions = std::size_t{2} * kMaxCoverBalls; ///< Of a pair.
    using RefineQuestions = StaticVector<RefineQuestion, kQuestions * kMaxPairs>;

    [[nodiscard]] static std::optional<FrameRefusal> check(const FrameSetup& setup) noexcept;

    void read_tools(std::span<const ToolState> tools) noexcept;
    void carry_proxies(std::span<const ObjectPose> poses) noexcept;
    void place_pairs(std::span<const ObjectPose> poses, const Budgets& budgets) noexcept;
    [[nodiscard]] double lead_s(ModelId model) const noexcept;
    [[nodiscard]] PairMotion motion_of(const ScenePair& pair) const noexcept;
    void load(const Budgets& budgets) noexcept TACTUS_NONBLOCKING;
    void refine(const Budgets& budgets) noexcept;
    void query(std::span<const ObjectPose> poses, const Budgets& budgets) noexcept;
    void respond(std::span<const ObjectPose> poses) noexcept;
    void report(std::span<const ObjectPose> poses) noexcept;
    void ask_about(ModelId model) noexcept;
    void ask_for_balls(std::uint32_t i) noexcept;
    void ask_for_mesh(std::uint32_t i, ModelId model) noexcept;
    void ask(bool is_asked, ModelId model, const RefineQuestion& question) noexcept;
    void query_core(std::uint32_t i, const ObjectPose& pose, const Budgets& budgets) noexcept;
    void query_mesh(std::uint32_t i, const ObjectPose& pose) noexcept;
    void report_pair(std::uint32_t i, const ObjectPose& pose) noexcept;
    [[nodiscard]] MeshPair* mesh_pair(std::uint32_t pair) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] ModelId tool_model_of(const ScenePair& pair) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] static bool looks_ahead(const ScenePair& pair) noexcept;
    [[nodiscard]] bool is_complete(ModelId model) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] ToolOutput follow(std::uint32_t tool,
                                    std::span<const PlacedSurface> surfaces) const noexcept;
    [[nodiscard]] double reach_of(std::uint32_t tool) const noexcept;
    [[nodiscard]] double radius_of(std::uint32_t tool) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] Vec3 ahead_of(std::uint32_t tool) const noexcept;
    [[nodiscard]] bool has_proxy(std::uint32_t tool) const noexcept;
    [[nodiscard]] RigidProxy* rigid_proxy(std::uint32_t tool) noexcept;
    [[nodiscard]] const RigidProxy* rigid_proxy(std::uint32_t tool) const noexcept;
    [[nodiscard]] const Vec3& position_of(std::uint32_t tool) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] const Mat3& rotation_of(std::uint32_t tool) const noexcept;
    [[nodiscard]] ToolOutput respond_rigidly(std::uint32_t tool,
                                             std::span<const ObjectPose> poses) noexcept;
    [[nodiscard]] double lower_of(std::uint32_t i, const ObjectPose& pose) noexcept;
    [[nodiscard]] double pair_rounding_m(std::uint32_t i, const ObjectPose& pose) noexcept;
    [[nodiscard]] ModelId model_of(const ScenePair& pair) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] FrameOutput finish() const noexcept;

    Scene scene_;
    std::int64_t period_ns_;
    std::int64_t pose_age_max_ns_;
    Prediction prediction_;
    FrameVariant variant_;
    std::array<std::optional<Model>, kMaxModels> models_;
    std::uint32_t model_count_{0};
    std::uint32_t frame_{ChunkCache::kFirstFrame};

    StaticVector<Proxy, kMaxTools> proxies_;
    std::array<ObjectPose, kMaxObjects> last_poses_{}; ///< If has_poses_.
    bool has_poses_{false};
    std::array<Vec3, kMaxTools> goals_{};
    std::array<Mat3, kMaxTools> rotations_{};
    /// How far the tool's farthest point went since the last frame.
    std::array<double, kMaxTools> ways_m_{};
    std::array<double, kMaxTools> elapsed_s_{};
    std::array<Vec3, kMaxTools> goal_velocities_m_per_s_{};
    std::array<SampleWatch, kMaxTools> sample_watches_{};
    std::array<RegionPredictor, kMaxPairs> predictors_{};
    std::span<RefineMemory> refine_memories_; ///< kQuestions a pair.
    RefineQuestions questions_;               ///< About the model that is being refined.
    std::array<QueryMemory, kMaxPairs> query_memories_{};
    std::span<LocalSurface> surfaces_;    ///< One a pair, and one for the rehearsal.
    std::span<ContactReport> contacts_;   ///< One a pair, if a tool wants them or is a mesh.
    std::span<MeshPair> mesh_pairs_;      ///< One a pair, if a tool is a mesh.
    std::span<RigidProxy> rigid_proxies_; ///< One a tool, if one has a torque.
    std::span<TouchReport> touches_;      ///< One a pair, if a tool has a torque.
    Budgets last_budgets_;

    std::array<ToolOutput, kMaxTools> tool_outputs_{};
    std::array<PairOutput, kMaxPairs> pair_outputs_{};
    std::array<ModelOutput, kMaxModels> model_outputs_{};
    std::array<DoorTake, kMaxModels> door_takes_{};
    WorkCounters work_;
    FrameFault faults_{FrameFault::none};
};

} // namespace tactus
