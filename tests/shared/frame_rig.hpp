// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/pool_memory.hpp"
#include "rt_core/frame/frame.hpp"
#include "tests/shared/rig_recorder.hpp"
#include "tests/shared/test_model.hpp"
#include "transport/courier.hpp"
#include "transport/loopback/loopback_link.hpp"
#include "transport/store/store_link.hpp"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace tactus::test
{

struct RigOptions
{
    std::size_t pool_bytes{std::size_t{8} << 20U}; ///< Of all models.
    std::size_t cache_bytes{0};                    ///< Of all models.
    std::vector<ToolSpec> tools;
    std::vector<ObjectSpec> objects; ///< Empty: one that shows the first model.
    /// Where their models stand at first; those without one in the world's frame.
    std::vector<ObjectPose> poses;
    SceneCapacities capacities;
    /// With faces in it all models are guests, and come and go in this.
    ModelCapacities for_guests;
    LoopbackFaults faults; ///< Of every model's link, each with a seed of its own.
    std::uint32_t courier_steps_per_frame{4};
    std::int64_t period_ns{1'000'000};
    bool cache_off{false};
    bool static_when_it_fits{false};
    Prediction prediction{Prediction::automatic};
    double force_tolerance_n{0.0};
    FrameVariant variant;
    bool record{false}; ///< Keep a recording; frames must then run through step() only.
};

/// The controller without clocks, threads and devices: a frame, and the courier that
/// reads its file through a link that may lose and delay. Steps all in turn.
class FrameRig
{
public:
    FrameRig(const TestModel& model, const RigOptions& options)
        : FrameRig(std::vector{&model}, options)
    {
    }
    /// From now on every rig's models are validated after each so manieth frame; never with 0, as
    /// at first. A flaw ends the program with a line. Test programs call it when they start
    /// (validated_rigs.cpp); a bench measures frames without it.
    static void validate_every(std::uint32_t frames);

    /// Models that no object shows are for tools that are meshes.
    FrameRig(const std::vector<const TestModel*>& models, const RigOptions& options);

    /// One frame with the tools at these places of the model's frame.
    FrameOutput step(const std::vector<Vec3>& goals_m, const Budgets& budgets, StageMark mark = {});
    FrameOutput step(const Vec3& goal_m, const Budgets& budgets = {})
    {
        return step(std::vector<Vec3>{goal_m}, budgets);
    }
    /// One frame with samples as a device gives them.
    FrameOutput step(std::span<const ToolState> tools, const Budgets& budgets);
    /// How an object's model stands from the next frame on; at first its frame is the world's.
    void place_object(const ObjectPose& pose, std::size_t object = 0);
    /// From the next frame on; of an object that comes, the pose is of its model's frame.
    void change(SceneChange change);
    /// The same, without letting the transport side work first.
    FrameOutput step_without_delivery(const std::vector<Vec3>& goals_m, const Budgets& budgets,
                                      StageMark mark);
    FrameOutput step_without_delivery(std::span<const ToolState> tools, const Budgets& budgets,
                                      StageMark mark);
    /// Lets the transport side work without a frame.
    void deliver();
    /// Steps with a still tool until the models are resident as far as the ball needs, at most
    /// `frames`; returns how many it took.
    std::uint32_t settle(const Vec3& goal_m, const Budgets& budgets, std::uint32_t frames);

    /// Of the model's frame, as the frame has it.
    [[nodiscard]] const ObjectPose& pose(std::size_t object = 0) const { return poses_[object]; }
    /// What the next frame gets, with these tools: for those that run it themselves.
    [[nodiscard]] FrameInput input(std::span<const ToolState> tools, const Budgets& budgets) const
    {
        return {tools, changes_, budgets, now_ns_};
    }
    [[nodiscard]] std::int64_t now_ns() const { return now_ns_; }
    [[nodiscard]] Frame& frame() { return *frame_; }
    [[nodiscard]] const Frame& frame() const { return *frame_; }
    [[nodiscard]] Model& model(ModelId id = ModelId{0}) { return frame_->model(id); }
    [[nodiscard]] Courier& courier() { return *courier_; }
    [[nodiscard]] LoopbackLink& link(ModelId id = ModelId{0}) { return *lines_[id.value].link; }
    /// The recording of all frames so far; once, at the end, and only with RigOptions::record.
    [[nodiscard]] RigRecorder& recorder() { return *recorder_; }
    [[nodiscard]] std::vector<std::byte> finish_recording() { return recorder_->finish(); }

private:
    /// What brings one model.
    struct Line
    {
        ServedModel served;
        std::unique_ptr<LoopbackLink> link;
    };

    void serve(const std::vector<const TestModel*>& models, const LoopbackFaults& faults);
    [[nodiscard]] std::vector<ModelSource> plan_pools(const FrameSetup& setup,
                                                      const RigOptions& options) const;
    [[nodiscard]] ObjectPose source_pose(const ObjectPose& pose, ModelId model) const;
    void make_courier();
    [[nodiscard]] std::uint32_t wishes_under_way() const;
    void validate();

    std::vector<Line> lines_; ///< One a model.
    PoolMemory memory_;
    std::optional<Arena> arena_;
    std::optional<Frame> frame_;
    std::optional<Courier> courier_;
    std::unique_ptr<RigRecorder> recorder_; ///< Null unless it records.
    std::uint32_t courier_steps_;
    std::int64_t period_ns_;
    std::int64_t now_ns_{0};
    std::uint64_t frames_{0};
    std::vector<ObjectPose> poses_;    ///< One for each place of an object.
    std::vector<ModelId> shown_;       ///< By each of them.
    std::vector<SceneChange> changes_; ///< Of the next frame.
    std::vector<ToolState> tools_;
};

/// Pools in which every chunk of a small model has room at once.
[[nodiscard]] RigOptions with_room_for_all();

/// Loads what a region asks for, without a frame: everything that the cache wishes for it, until it
/// has nothing left to wish for. The pools must hold that.
void load_region(FrameRig& rig, const RankedRegion& region);

/// Loads every chunk of a rig's model; its pools must hold them all.
void load_everything(FrameRig& rig);

/// Every face of a model's finest mesh in the order of the AB-Tree's paths, read from the base mesh
/// and the records; all of them must be loaded.
[[nodiscard]] std::vector<FaceId> faces_by_path(Model& model);

} // namespace tactus::test
