// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/pool_memory.hpp"
#include "platform/recording/frame_encoder.hpp"
#include "platform/recording/recording_writer.hpp"
#include "rt_core/frame/frame.hpp"
#include "tests/shared/loopback_link.hpp"
#include "tests/shared/test_model.hpp"
#include "transport/chunk_loader.hpp"
#include "transport/store/store_link.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace tactus::test
{

/// Recorder of the frames of one rig, in memory and on its thread.
class RigRecorder
{
public:
    explicit RigRecorder(const FrameSetup& setup) : writer_(to_recorded(setup)) {}

    /// Copies each piece that `chunk_loader` hands over from now on; the chunk loader must not be
    /// used after the recorder's end.
    void follow(ChunkLoader& chunk_loader);

    void add_name(const RecordedName& what, std::string_view name) { writer_.add_name(what, name); }
    void add(const FrameInput& input, const FrameOutput& output);
    /// Whole recording; nothing may be added afterwards.
    [[nodiscard]] std::vector<std::byte> finish();

private:
    /// Pieces of one model.
    class Line final : public PieceSink
    {
    public:
        Line(RecordingWriter& writer, std::uint32_t model) : writer_(writer), model_(model) {}
        void receive(ContentKey key, std::span<const std::byte> bytes) override
        {
            writer_.add_piece(model_, key, bytes);
        }

    private:
        RecordingWriter& writer_;
        std::uint32_t model_;
    };

    RecordingWriter writer_;
    FrameEncoder encoder_;
    std::vector<std::unique_ptr<Line>> lines_;
};

struct RigOptions
{
    std::size_t pool_bytes{std::size_t{8} << 20U};
    std::size_t cache_bytes{0}; ///< Page cache of all models.
    std::vector<ToolSpec> tools;
    std::vector<ObjectSpec> objects; ///< Objects; empty: one that shows the first model.
    /// Poses of the objects' models at the start; by default the world frame.
    std::vector<ObjectPose> poses;
    SceneCapacities capacities;
    /// Capacities of streamed models; if its faces are not 0, all models are streamed.
    ModelCapacities for_streamed_models;
    LoopbackFaults faults; ///< Faults of every model's link, each with its own seed.
    std::uint32_t chunk_loader_steps_per_frame{4};
    std::int64_t period_ns{1'000'000};
    bool cache_off{false};
    /// Room for faces that edits add, of each model that an object shows at the start.
    std::uint32_t edit_faces{0};
    bool static_when_it_fits{false};
    Prediction prediction{Prediction::automatic};
    double force_tolerance_n{0.0};
    FrameVariant variant;
    bool record{false}; ///< Records the frames, which must then run through step() only.
};

/// Controller without clocks, threads and devices: a frame, and the loader that reads its file over
/// a link with optional loss and delay. All run in turn.
class FrameRig
{
public:
    FrameRig(const TestModel& model, const RigOptions& options)
        : FrameRig(std::vector{&model}, options)
    {
    }
    /// Validates the models of every rig after each `frames` frames; 0, the default, never. A flaw
    /// ends the program with a line. Test programs call this at the start (validated_rigs.cpp); a
    /// bench measures frames without it.
    static void validate_every(std::uint32_t frames);

    /// Creates a rig; models that no object shows are for mesh tools.
    FrameRig(const std::vector<const TestModel*>& models, const RigOptions& options);

    /// One frame with the tools at these positions of the model frame.
    FrameOutput step(const std::vector<Vec3>& goals_m, const Budgets& budgets, StageMark mark = {});
    FrameOutput step(const Vec3& goal_m, const Budgets& budgets = {})
    {
        return step(std::vector<Vec3>{goal_m}, budgets);
    }
    /// One frame with a device's samples.
    FrameOutput step(std::span<const ToolState> tools, const Budgets& budgets);
    /// Sets the pose of an object's model from the next frame on; initially its frame is the
    /// world's.
    void place_object(const ObjectPose& pose, std::size_t object = 0);
    /// Adds a change for the next frame; the pose of an added object is that of its model frame.
    void change(SceneChange change);
    /// Adds an edit for the next frame; its spans are copied.
    void edit(const SurfaceEdit& edit);
    /// One frame without a step of the transport side before it.
    FrameOutput step_without_delivery(const std::vector<Vec3>& goals_m, const Budgets& budgets,
                                      StageMark mark);
    FrameOutput step_without_delivery(std::span<const ToolState> tools, const Budgets& budgets,
                                      StageMark mark);
    /// Steps the transport side without a frame.
    void deliver();
    /// Steps with a still tool until the models are resident for the sphere, at most `frames`;
    /// returns the number of steps.
    std::uint32_t settle(const Vec3& goal_m, const Budgets& budgets, std::uint32_t frames);

    /// Present pose of the model frame.
    [[nodiscard]] const ObjectPose& pose(std::size_t object = 0) const { return poses_[object]; }
    /// Input of the next frame with these tools, for callers that run it themselves.
    [[nodiscard]] FrameInput input(std::span<const ToolState> tools, const Budgets& budgets) const
    {
        return {tools, changes_, budgets, now_ns_, edits_};
    }
    [[nodiscard]] std::int64_t now_ns() const { return now_ns_; }
    [[nodiscard]] Frame& frame() { return *frame_; }
    [[nodiscard]] const Frame& frame() const { return *frame_; }
    [[nodiscard]] Model& model(ModelId id = ModelId{0}) { return frame_->model(id); }
    [[nodiscard]] ChunkLoader& chunk_loader() { return *chunk_loader_; }
    [[nodiscard]] LoopbackLink& link(ModelId id = ModelId{0}) { return *lines_[id.value].link; }
    /// Recorder of all frames so far. finish_recording() is for the end, once, and only with
    /// RigOptions::record.
    [[nodiscard]] RigRecorder& recorder() { return *recorder_; }
    [[nodiscard]] std::vector<std::byte> finish_recording() { return recorder_->finish(); }

private:
    /// Transport of one model.
    struct Line
    {
        ServedModel served;
        std::unique_ptr<LoopbackLink> link;
    };

    void serve(const std::vector<const TestModel*>& models, const LoopbackFaults& faults);
    [[nodiscard]] std::vector<ModelSource> plan_pools(const FrameSetup& setup,
                                                      const RigOptions& options) const;
    [[nodiscard]] ObjectPose source_pose(const ObjectPose& pose, ModelId model) const;
    void make_chunk_loader();
    [[nodiscard]] std::uint32_t requests_under_way() const;
    void validate();

    std::vector<Line> lines_; ///< Transport of each model.
    PoolMemory memory_;
    std::optional<Arena> arena_;
    std::optional<Frame> frame_;
    std::optional<ChunkLoader> chunk_loader_;
    std::unique_ptr<RigRecorder> recorder_; ///< Recorder; null unless the rig records.
    std::uint32_t chunk_loader_steps_;
    std::int64_t period_ns_;
    std::int64_t now_ns_{0};
    std::uint64_t frames_{0};
    std::vector<ObjectPose> poses_;    ///< Poses, one for each place of an object.
    std::vector<ModelId> shown_;       ///< Models that they show.
    std::vector<SceneChange> changes_; ///< Changes of the next frame.
    std::vector<SurfaceEdit> edits_;   ///< Edits of the next frame, with their faces.
    std::deque<std::vector<FaceId>> removed_;
    std::deque<std::vector<AddedFace>> added_;
    std::vector<ToolState> tools_;
};

/// Pools that hold every chunk of a small model at once.
[[nodiscard]] RigOptions with_room_for_all();

/// Loads a region without a frame: all requests of the cache until there are none left. The pools
/// must hold it.
void load_region(FrameRig& rig, const RankedRegion& region);

/// Loads every chunk of a rig's model; its pools must hold them all.
void load_everything(FrameRig& rig);

/// Every face of a model's finest mesh in the order of the AB-Tree's paths, from the base mesh and
/// the records; all must be loaded.
[[nodiscard]] std::vector<FaceId> faces_by_path(Model& model);

} // namespace tactus::test
