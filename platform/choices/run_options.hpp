// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/choices/device_choice.hpp"
#include "platform/choices/file_readers.hpp"
#include "platform/choices/fixture.hpp"
#include "platform/choices/placement.hpp"
#include "platform/choices/scene_materials.hpp"
#include "platform/choices/tool_choice.hpp"
#include "platform/devices/simulated/operator_motions.hpp"
#include "platform/machine/rt_thread.hpp"
#include "rt_core/kernels/kernels.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/prediction.hpp"
#include "transport/model_name.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::hrtc
{

enum class TransportKind : std::uint8_t
{
    dds,
    file,
};

/// What a simulated operator does, and on what.
struct OperatorChoice
{
    MotionKind motion{MotionKind::script};
    std::string object; ///< Its name, or its model's; empty: each hand has another object.
};

/// What is asked for of one tool.
struct ToolOptions
{
    std::optional<ToolChoice> shape; ///< None: default_tool().
    ToolLoad load;                   ///< What hangs on the device.
    std::optional<FixtureChoice> fixture;
    DeviceChoice device;
    OperatorChoice hand; ///< Operator of a simulated device.

    /// ToolChoice's; empty: it is no mesh.
    [[nodiscard]] std::string mesh_model() const
    {
        return shape ? shape->mesh_model : std::string();
    }
};

/// Everything that a run is asked for; checked, in SI.
struct Options
{
    FileReaders readers; ///< The program's.
    /// NAME, NAME@HASH or NAME@SERVER, or paths with the file transport; each once.
    std::vector<std::string> models;
    std::vector<PlacedObject> objects; ///< By their numbers; each model is shown by one at least.
    /// Not empty: models and objects are this file's, or with DDS those of the host whose scene has
    /// this name, or NAME@SERVER; see scene_choice.hpp.
    std::string scene;
    SceneMaterials scene_materials; ///< Where --material says otherwise than the scene.
    std::uint32_t objects_max{0};   ///< Room for so many; 0: as many as there are.
    std::vector<ToolOptions> tools{1};
    std::vector<DeviceFault> device_faults; ///< Of every simulated device.
    TransportKind transport{TransportKind::dds};
    std::uint32_t domain{0};
    bool is_watched{false};   ///< On that domain viewers see it, with models from files, too.
    std::string name;         ///< Of the controller, with DDS; empty: hrtc-PID.
    Failover failover;        ///< With DDS.
    bool follows_poses{true}; ///< Objects move as the hosts say.
    bool shows_refinement_state{true}; ///< With DDS: tells which records are split.
    double wait_s{10.0};               ///< For a model that nobody publishes yet, or a device.
    std::int64_t rate_hz{1'000};
    double duration_s{10.0};
    std::vector<std::string> report_paths;
    std::string record_path;       ///< Empty: no recording.
    std::string trace_path;        ///< Empty: no trace.
    std::string histograms_folder; ///< Empty: no histograms.
    std::string replay_path; ///< Not empty: replay this recording; but for `kernels` and the next
                             ///< one, nothing else is set then.
    std::vector<std::string> export_paths; ///< Of a replay, for other tools.
    double pool_mib{2.0};
    double cache_mib{0.0};                 ///< 0: the usual share of the pool.
    std::uint32_t splits{64};              ///< At most, when there is a frame budget.
    std::optional<double> frame_budget_us; ///< None: half of the period.
    bool static_when_it_fits{true};
    Prediction prediction{Prediction::automatic};
    const Kernels* kernels{nullptr}; ///< Of the queries; null: the best of the processor.
    double stiffness_n_per_m{500.0};
    double angular_stiffness_nm_per_rad{0.0}; ///< 0: as the stiffness and the tool's size make it.
    double shading_m{0.0};                    ///< 0: facets are felt.
    double force_tolerance_n{kForceToleranceUsual_n}; ///< FrameSetup's.
    std::optional<double> speed_limit_m_per_s;        ///< None: the device's own.
    double object_speed_m_per_s{0.5};                 ///< Speed limit near a tool.
    std::optional<std::uint32_t> clutch_button;       ///< A button, the same on every device.
    /// Of a silent loop, until the supervisor brakes. None: as the kernel can promise.
    std::optional<std::uint32_t> supervisor_periods;
    /// None: one diagonal of the first model a second.
    std::optional<double> proxy_speed_m_per_s;
    double slew_share_per_ms{kSlewShare_per_ms}; ///< ChangeRule's.
    bool trap_system_calls{false};
    bool virtual_time{false}; ///< See LoopTime; with files and hands that the program moves alone.
    bool strict{false};       ///< What is lost in a run, or comes to nothing, is a failure.
    std::string as_file;      ///< All options, as a file for --config.
    RtThreadOptions thread;

    /// How a refusal names an option of a tool: with the tool's number when there are several.
    [[nodiscard]] std::string of_tool(std::string_view option, std::size_t tool) const
    {
        return std::string(option) + (tools.size() > 1 ? " of tool " + std::to_string(tool) : "");
    }
    [[nodiscard]] std::size_t pool_bytes() const noexcept
    {
        return static_cast<std::size_t>(pool_mib * 0x1p20);
    }
    [[nodiscard]] Duration period() const noexcept { return nanoseconds(1'000'000'000 / rate_hz); }
    /// The time that a frame may take.
    [[nodiscard]] Duration frame_budget() const noexcept
    {
        return frame_budget_us ? nanoseconds(static_cast<std::int64_t>(*frame_budget_us * 1e3))
                               : nanoseconds(period().ns / 2);
    }
    /// So many times the usual work a frame may do with the tools that there are.
    [[nodiscard]] std::uint32_t work_times() const noexcept
    {
        const auto any = [this](std::string ToolChoice::*file)
        {
            return std::ranges::any_of(tools, [file](const ToolOptions& tool)
                                       { return tool.shape && !((*tool.shape).*file).empty(); });
        };
        return any(&ToolChoice::mesh_model)  ? Budgets::kMeshWork
               : any(&ToolChoice::hull_file) ? Budgets::kHullWork
                                             : 1U;
    }
    /// The work that a frame may do.
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
