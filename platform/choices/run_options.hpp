// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/choices/device_choice.hpp"
#include "platform/choices/file_readers.hpp"
#include "platform/choices/fixture_choice.hpp"
#include "platform/choices/scene_materials.hpp"
#include "platform/choices/tool_choice.hpp"
#include "platform/devices/simulated/faulty_device.hpp"
#include "platform/devices/simulated/motion_kind.hpp"
#include "platform/machine/rt_thread.hpp"
#include "platform/machine/time.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/prediction.hpp"
#include "rt_core/records/tool_load.hpp"
#include "transport/base/network_security.hpp"
#include "transport/model_name.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus
{

struct Kernels;

} // namespace tactus

namespace tactus::hrtc
{

class ExternalForceSource;

enum class TransportKind : std::uint8_t
{
    dds,
    file,
};

/// Motion and object of a simulated operator.
struct OperatorChoice
{
    MotionKind motion{MotionKind::script};
    /// Name of an object or of its model; empty: each operator gets another object.
    std::string object;
};

struct ToolOptions
{
    std::optional<ToolChoice> shape; ///< Shape; none: default_tool().
    ToolLoad load;                   ///< Payload of the device.
    std::optional<FixtureChoice> fixture;
    DeviceChoice device;
    OperatorChoice simulated; ///< Operator of a simulated device.
    /// Greatest volume in a second that the tool carves (BurrLaw); 0: it edits no models.
    double carve_rate_m3_per_s{0.0};
    /// External force of a program, borrowed; null without one, and with a fixture.
    ExternalForceSource* external_force{nullptr};

    /// Mesh model of the tool's shape; empty if the tool is no mesh.
    [[nodiscard]] std::string mesh_model() const
    {
        return shape ? shape->mesh_model : std::string();
    }
};

/// All options of a run, checked, in SI units.
struct Options
{
    FileReaders readers; ///< File readers of the program.
    /// Models, each once: NAME, NAME@HASH or NAME@SERVER; paths with the file transport.
    std::vector<std::string> models;
    /// Objects by their numbers; each model is shown by at least one.
    std::vector<PlacedObject> objects;
    /// Scene: a file, or with DDS the name of a server's scene or NAME@SERVER; empty: none. The
    /// scene gives models and objects then; see scene_choice.hpp.
    std::string scene;
    SceneMaterials scene_materials; ///< Materials of --material, which override the scene's.
    /// Largest number of objects; 0: the number at the start, or for a server's scene
    /// SceneRoom::of().
    std::uint32_t objects_max{0};
    std::vector<ToolOptions> tools{1};
    /// False: no process brakes the devices of wants_guard() if this one is killed.
    bool has_guardian{true};
    std::vector<DeviceFault> device_faults; ///< Faults of every simulated device.
    TransportKind transport{TransportKind::dds};
    std::uint32_t domain{0};
    NetworkSecurity security; ///< Keys, or the choice to join a network without.
    /// True if viewers of that domain can watch, also with models from files.
    bool is_watched{false};
    std::string name;                  ///< Name of the controller, with DDS; empty: hrtc-PID.
    Failover failover;                 ///< Servers that may replace a lost one; DDS only.
    bool follows_poses{true};          ///< Objects take the poses that the servers send.
    bool shows_refinement_state{true}; ///< Sends the refinement state to viewers; DDS only.
    /// Longest wait for a device, or for a model that is not published yet.
    double wait_s{10.0};
    std::int64_t rate_hz{1'000};
    double duration_s{10.0};
    /// The run ends by its hooks or stop() alone; `duration_s` is the time of simulated operators.
    bool runs_until_stopped{false};
    /// The caller runs each frame by SessionRun::step(); only with `virtual_time`.
    bool is_stepped{false};
    std::vector<std::string> report_paths;
    std::string record_path;       ///< File of the recording; empty: none.
    std::string trace_path;        ///< File of the trace; empty: none.
    std::string histograms_folder; ///< Folder of the histograms; empty: none.
    /// Recording to replay; empty: none. Only `kernels` and `export_paths` may be set beside it.
    std::string replay_path;
    std::vector<std::string> export_paths; ///< Files of an export of the replay, for other tools.
    double pool_mib{2.0};
    double cache_mib{0.0}; ///< Size of the cache; 0: the usual share of the pool.
    /// Room of each editable model for faces that edits add; none: as large as the server's.
    std::optional<std::uint32_t> edit_faces;
    std::uint32_t splits{64};              ///< Most splits, and most merges, in a frame.
    std::optional<double> frame_budget_us; ///< Time budget of a frame; none: half of the period.
    bool static_when_it_fits{true};
    Prediction prediction{Prediction::automatic};
    const Kernels* kernels{nullptr}; ///< Kernels of the queries; null: the best of the processor.
    double stiffness_n_per_m{500.0};
    /// Angular stiffness; 0: derived from the stiffness and the tool's size.
    double angular_stiffness_nm_per_rad{0.0};
    double shading_m{0.0}; ///< Width of force shading; 0: facets are felt.
    double force_tolerance_n{kForceToleranceUsual_n}; ///< Value of FrameSetup::force_tolerance_n.
    /// Speed limit of the devices; none: each device's own.
    std::optional<double> speed_limit_m_per_s;
    double object_speed_m_per_s{0.5}; ///< Speed limit of objects near a tool.
    /// Number of the clutch button, the same on every device.
    std::optional<std::uint32_t> clutch_button;
    /// Silent periods of the loop before the supervisor brakes. None: silent_periods() of the
    /// machine.
    std::optional<std::uint32_t> supervisor_periods;
    /// Speed limit of the proxy. None: one diagonal of the first model per second.
    std::optional<double> proxy_speed_m_per_s;
    double slew_share_per_ms{kSlewShare_per_ms}; ///< Slew rate of ChangeRule.
    bool trap_system_calls{false};
    /// Virtual time, see LoopTime. Needs models from files, and simulated or replayed devices.
    bool virtual_time{false};
    bool strict{false};  ///< A run with losses or without a result counts as a failure.
    std::string as_file; ///< All options in the form of a --config file.
    RtThreadOptions thread;
    /// Room of each of the `models` of files for faces that edits add; too short: none.
    std::vector<std::uint32_t> edit_rooms;

    /// Name of a tool's option for a refusal, with the tool's number if there are several.
    [[nodiscard]] std::string of_tool(std::string_view option, std::size_t tool) const
    {
        return std::string(option) + (tools.size() > 1 ? " of tool " + std::to_string(tool) : "");
    }
    [[nodiscard]] std::size_t pool_bytes() const noexcept
    {
        return static_cast<std::size_t>(pool_mib * 0x1p20);
    }
    [[nodiscard]] Duration period() const noexcept { return nanoseconds(1'000'000'000 / rate_hz); }
    /// Time budget of a frame.
    [[nodiscard]] Duration frame_budget() const noexcept
    {
        return frame_budget_us ? nanoseconds(static_cast<std::int64_t>(*frame_budget_us * 1e3))
                               : nanoseconds(period().ns / 2);
    }
    /// Factor by which a frame may do more than the usual work, from the tools' shapes.
    [[nodiscard]] std::uint32_t work_times() const noexcept
    {
        const auto is_mesh = [](const ToolOptions& tool)
        { return tool.shape && !tool.shape->mesh_model.empty(); };
        const auto is_hull = [](const ToolOptions& tool)
        { return tool.shape && (!tool.shape->hull_file.empty() || tool.shape->hull_vertices); };
        return std::ranges::any_of(tools, is_mesh)   ? Budgets::kMeshWork
               : std::ranges::any_of(tools, is_hull) ? Budgets::kHullWork
                                                     : 1U;
    }
    /// Work budget of a frame.
    [[nodiscard]] std::uint32_t frame_work() const noexcept
    {
        return Budgets::work_of(frame_budget().ns, work_times());
    }
    [[nodiscard]] std::uint64_t frames() const noexcept
    {
        return static_cast<std::uint64_t>(duration_s * static_cast<double>(rate_hz));
    }
};

} // namespace tactus::hrtc
