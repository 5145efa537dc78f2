// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/choices/run_options.hpp"
#include "platform/devices/haptic_device.hpp"
#include "platform/loop/tool_port.hpp"
#include "platform/machine/pool_memory.hpp"
#include "platform/machine/posix/posix_clock.hpp"
#include "platform/scene/scene_parts.hpp"
#include "rt_core/frame/frame.hpp"
#include "transport/base/refusal.hpp"
#include "transport/chunk_loader.hpp"
#include "transport/served_model.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::hrtc
{

/// Everything between the transport and the devices: the pools, the frame in them, the chunk
/// loader, the objects' poses and the devices. Assembled before any thread starts.
class Controller
{
public:
    /// Opens the devices, waiting for those that have to come as long as `goes_on`, lays out all
    /// pools inside options.pool_mib, brings the base meshes that aren't here, makes the frame, and
    /// a simulated device for each tool without another. Of streamed models it brings the base
    /// meshes that simulated operators need alone. Refused when a device isn't there or doesn't run
    /// at that rate, when a base mesh doesn't come in options.wait_s, or when the pools are too
    /// small, with the size that would do for a start.
    [[nodiscard]] static Result<std::unique_ptr<Controller>, Refusal>
    create(const Options& options, std::vector<ServedModel> models, const Log& log,
           const std::function<bool()>& goes_on);

    [[nodiscard]] Frame& frame() noexcept { return *frame_; }
    [[nodiscard]] const Frame& frame() const noexcept { return *frame_; }
    [[nodiscard]] ChunkLoader& chunk_loader() noexcept { return *chunk_loader_; }
    [[nodiscard]] const ChunkLoader& chunk_loader() const noexcept { return *chunk_loader_; }
    [[nodiscard]] std::vector<ToolSetup>& tools() noexcept { return tools_; }
    [[nodiscard]] const std::vector<ToolSetup>& tools() const noexcept { return tools_; }
    /// By their numbers, with where they stand at the start.
    [[nodiscard]] const std::vector<ObjectSpec>& objects() const noexcept { return objects_; }
    /// Of each model the number of the first object that shows it: the one that its host moves
    /// where no scene is followed. That of no object where none shows it at the start.
    [[nodiscard]] std::vector<std::uint32_t> first_objects() const;
    /// Its views are into the controller.
    [[nodiscard]] SceneParts scene_parts() const;
    [[nodiscard]] const std::vector<ObjectPose>& poses() const noexcept { return poses_; }
    [[nodiscard]] const std::vector<ServedModel>& models() const noexcept { return models_; }
    [[nodiscard]] const Budgets& budgets() const noexcept { return budgets_; }
    /// What the frame was made of.
    [[nodiscard]] const FrameSetup& setup() const noexcept { return setup_; }
    /// The frame itself, its pools and tables, and the transport's side of them.
    [[nodiscard]] std::size_t pool_bytes() const noexcept { return arena_->used() + sizeof(Frame); }
    /// Of the first model, placed: widths are reported in it.
    [[nodiscard]] double diagonal_world_m() const noexcept;

private:
    Controller(std::vector<ServedModel> models, const std::function<bool()>& goes_on);

    [[nodiscard]] std::optional<Refusal> lay_out_pools(const Options& options);
    [[nodiscard]] std::optional<Refusal> fetch_bases(std::span<ServedModel> models,
                                                     const Options& options) const;
    [[nodiscard]] bool try_plan_as_streamed_models(const Options& options, std::size_t bytes,
                                                   std::size_t cache);
    void make_poses(const Options& options);
    [[nodiscard]] std::optional<Refusal> open_devices(const Options& options);
    void make_tools(const Options& options);
    [[nodiscard]] std::optional<Refusal> check_tolerance(const Options& options) const;
    void make_chunk_loader(const Log& log);
    [[nodiscard]] std::optional<Refusal> simulate_device(const Options& options, std::size_t tool);
    [[nodiscard]] std::optional<Refusal> finish_devices(const Options& options);
    void limit_force(const Options& options, ToolSetup& tool) const;
    [[nodiscard]] std::optional<Refusal> check_grippers(const Options& options) const;
    [[nodiscard]] std::optional<Refusal> check_damping(const Options& options) const;
    [[nodiscard]] std::optional<Refusal> hang_load(const Options& options, std::size_t tool);
    [[nodiscard]] Result<std::size_t, Refusal> object_of_hand(const Options& options,
                                                              std::size_t tool) const;
    /// Whether its host may move it.
    [[nodiscard]] bool is_followed(const Options& options, std::size_t object) const;
    [[nodiscard]] double diagonal_of(std::size_t object) const noexcept;
    [[nodiscard]] std::vector<Vec3> anchors_world_m(std::size_t object) const;

    std::function<bool()> goes_on_;
    std::vector<ServedModel> models_;
    std::vector<ModelHeader> headers_; ///< Views into models_.
    std::vector<ObjectPose> poses_;
    std::vector<ToolSpec> tool_specs_; ///< Those of tools_, in one piece for the frame.
    std::vector<ObjectSpec> objects_;
    std::vector<ModelSource> sources_; ///< Views into models_.
    FrameSetup setup_;                 ///< Views into the above.
    Budgets budgets_;
    std::optional<PoolMemory> memory_; ///< As much as the plan needs.
    std::optional<Arena> arena_;
    std::optional<Frame> frame_;
    std::optional<ChunkLoader> chunk_loader_;
    PosixClock clock_; ///< Clock of the devices that aren't simulated.
    std::vector<std::unique_ptr<VirtualFixture>> fixtures_; ///< Fixtures, lent to the tools.
    std::vector<ToolSetup> tools_;
    std::vector<std::size_t> objects_of_hands_; ///< Of the simulated ones, so far.
};

} // namespace tactus::hrtc
