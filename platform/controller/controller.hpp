// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/tool_port.hpp"
#include "platform/machine/posix/posix_clock.hpp"
#include "platform/scene/scene_parts.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/frame/frame_setup.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/object_pose.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/base/refusal.hpp"
#include "transport/log.hpp"
#include "transport/served_model.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace tactus
{

class ChunkLoader;
class Frame;
class ObjectTable;
struct PagePool;

} // namespace tactus

namespace tactus::hrtc
{

class VirtualFixture;
struct Options;

/// All parts of a run between the transport and the devices: pools, frame, chunk loader, object
/// poses and devices. create() assembles them before any thread starts.
class Controller
{
public:
    /// Opens the devices, and waits for missing ones while `goes_on` returns true. Lays out all
    /// pools inside options.pool_mib, fetches missing base meshes, and starts the frame. A tool
    /// without an opened device gets a simulated one. For streamed models, only the base meshes for
    /// simulated operators are fetched. Refused if a device is missing or can't run at
    /// options.rate_hz, or if a base mesh takes longer than options.wait_s. Also refused if the
    /// pools are too small; the refusal gives the size that suffices for a start.
    [[nodiscard]] static Result<std::unique_ptr<Controller>, Refusal>
    create(const Options& options, std::vector<ServedModel> models, const Log& log,
           const std::function<bool()>& goes_on);

    Controller(const Controller&) = delete;
    Controller& operator=(const Controller&) = delete;
    ~Controller();

    [[nodiscard]] Frame& frame() noexcept;
    [[nodiscard]] const Frame& frame() const noexcept;
    /// Objects of the frame by their numbers.
    [[nodiscard]] const ObjectTable& object_table() const noexcept;
    /// Page slots of the frame's models.
    [[nodiscard]] PagePool& page_pool() noexcept;
    [[nodiscard]] ChunkLoader& chunk_loader() noexcept;
    [[nodiscard]] const ChunkLoader& chunk_loader() const noexcept;
    [[nodiscard]] std::vector<ToolSetup>& tools() noexcept { return tools_; }
    [[nodiscard]] const std::vector<ToolSetup>& tools() const noexcept { return tools_; }
    /// Objects by their numbers, with their places at the start.
    [[nodiscard]] const std::vector<ObjectSpec>& objects() const noexcept { return objects_; }
    /// Number of the first object that shows each model, one entry a model; objects().size() if
    /// none does at the start. Without a followed scene, the model's server moves that object.
    [[nodiscard]] std::vector<std::uint32_t> first_objects() const;
    /// Parts of the scene, with views into the controller.
    [[nodiscard]] SceneParts scene_parts() const;
    [[nodiscard]] const std::vector<ObjectPose>& poses() const noexcept { return poses_; }
    [[nodiscard]] const std::vector<ServedModel>& models() const noexcept { return models_; }
    [[nodiscard]] const Budgets& budgets() const noexcept { return budgets_; }
    /// Setup of the frame at its start.
    [[nodiscard]] const FrameSetup& setup() const noexcept { return setup_; }
    /// Bytes of the frame, its pools and tables, and the chunk loader's memory.
    [[nodiscard]] std::size_t pool_bytes() const noexcept;
    /// Diagonal of the first object, in the world.
    [[nodiscard]] double diagonal_world_m() const noexcept;

private:
    /// Frame and chunk loader, with the memory of their pools.
    struct Core;

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
    [[nodiscard]] Result<std::size_t, Refusal> object_of_operator(const Options& options,
                                                                  std::size_t tool) const;
    /// True if a server may move the object.
    [[nodiscard]] bool is_followed(const Options& options, std::size_t object) const;
    [[nodiscard]] double diagonal_of(std::size_t object) const noexcept;
    [[nodiscard]] std::vector<Vec3> anchors_world_m(std::size_t object) const;

    std::function<bool()> goes_on_;
    std::vector<ServedModel> models_;
    std::vector<ModelHeader> headers_; ///< Views into models_.
    std::vector<ObjectPose> poses_;
    std::vector<ToolSpec> tool_specs_; ///< Specs of tools_, contiguous for the frame.
    std::vector<ObjectSpec> objects_;
    std::vector<ModelSource> sources_; ///< Views into models_.
    FrameSetup setup_;                 ///< Views into the members above.
    Budgets budgets_;
    std::unique_ptr<Core> core_; ///< Null before lay_out_pools().
    PosixClock clock_;           ///< Clock of the devices that aren't simulated.
    std::vector<std::unique_ptr<VirtualFixture>> fixtures_; ///< Fixtures, which the tools borrow.
    std::vector<ToolSetup> tools_;
    /// Object numbers of the simulated operators made so far.
    std::vector<std::size_t> operator_objects_;
};

} // namespace tactus::hrtc
