// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/controller.hpp"

#include "platform/hrtc/object_pose.hpp"
#include "platform/simulated/hand_motions.hpp"
#include "platform/simulated/simulated_device.hpp"
#include "rt_core/force/stiffness_rule.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::hrtc
{

namespace
{

constexpr double kBytesPerMib = 1024.0 * 1024.0;
/// A tool when none is named, as a share of the first model's diagonal.
constexpr double kDefaultToolShare = 0.01;
/// Without --follow-speed.
constexpr double kSpeedMax_diag = 1.0;
/// The simulated hand flies at two diagonals a second; its device stands twice that.
constexpr double kHandSpeed_diag = 4.0;

/// Without one it is simulated.
DeviceChoice choice_of(const Options& options, std::size_t tool)
{
    return tool < options.devices.size() ? options.devices[tool] : DeviceChoice{};
}

} // namespace

Result<std::unique_ptr<Controller>, Refusal>
Controller::create(const Options& options, std::vector<ServedModel> models, const Log& log,
                   const std::function<bool()>& goes_on)
{
    std::unique_ptr<Controller> controller(new Controller(options, std::move(models)));
    controller->make_poses(options);
    if (std::optional<Refusal> error = controller->open_devices(options, goes_on))
    {
        return *error;
    }
    controller->make_tools(options);
    if (std::optional<Refusal> error = controller->lay_out_pools(options))
    {
        return *error;
    }
    controller->make_couriers(log);
    if (std::optional<Refusal> error = controller->finish_devices(options))
    {
        return *error;
    }
    return controller;
}

Controller::Controller(const Options& options, std::vector<ServedModel> models)
    : models_(std::move(models))
    , memory_(static_cast<std::size_t>(options.pool_mib * kBytesPerMib) - sizeof(Frame))
    , arena_(memory_.span())
{
    for (const ServedModel& model : models_)
    {
        headers_.push_back(ModelHeader::parse(model.header).value());
    }
    budgets_.splits = options.splits;
    budgets_.merges = options.splits;
}

double Controller::diagonal_world_m() const noexcept
{
    return headers_.front().diagonal_m() * poses_.front().scale;
}

void Controller::make_poses(const Options& options)
{
    for (std::size_t i = 0; i < models_.size(); ++i)
    {
        poses_.push_back(object_pose(options.placements[i], headers_[i]));
    }
}

/// Those that aren't simulated; before the tools, which need to know what the devices can do.
std::optional<Refusal> Controller::open_devices(const Options& options,
                                                const std::function<bool()>& goes_on)
{
    tools_.resize(std::max<std::size_t>(options.tool_radii_m.size(), 1));
    const DeviceWait wait{milliseconds(static_cast<std::int64_t>(options.wait_s * 1e3)), goes_on};
    for (std::size_t i = 0; i < options.devices.size(); ++i)
    {
        if (options.devices[i].kind == DeviceKind::simulated)
        {
            continue;
        }
        auto device = open_device(options.devices[i], i, wait, clock_);
        if (!device)
        {
            return Refusal{"--device: " + device.error().text};
        }
        const DeviceInfo& info = device.value()->info();
        if (options.rate_hz < info.rate_min_hz || options.rate_hz > info.rate_max_hz)
        {
            return Refusal{fmt::format("--rate: {} Hz; the device {} takes {} to {} Hz",
                                       options.rate_hz, info.name, info.rate_min_hz,
                                       info.rate_max_hz)};
        }
        tools_[i].device = std::move(device).value();
    }
    return std::nullopt;
}

void Controller::make_tools(const Options& options)
{
    std::vector<double> radii_m = options.tool_radii_m;
    if (radii_m.empty())
    {
        radii_m.push_back(kDefaultToolShare * diagonal_world_m());
    }
    for (std::size_t i = 0; i < tools_.size(); ++i)
    {
        ToolSetup& tool = tools_[i];
        const DeviceLimits limits =
            tool.device != nullptr ? tool.device->info().limits : choice_of(options, i).limits;
        tool.spec = {radii_m[i], options.stiffness_n_per_m, limits.force_max_n,
                     options.follow_speed_m_per_s.value_or(kSpeedMax_diag * diagonal_world_m())};
        tool_specs_.push_back(tool.spec);
    }
}

/// Every model gets the same share of the memory; what belongs to no model comes off first.
std::optional<Refusal> Controller::lay_out_pools(const Options& options)
{
    for (std::size_t i = 0; i < models_.size(); ++i)
    {
        objects_.push_back({ModelId{static_cast<std::uint32_t>(i)}, options.materials[i]});
    }
    setup_.objects = objects_;
    setup_.tools = tool_specs_;
    setup_.static_when_it_fits = options.static_when_it_fits;
    setup_.prediction = options.prediction;
    setup_.period_ns = options.period().ns;
    std::size_t shared = Frame::required_bytes(setup_);
    for (const ServedModel& model : models_)
    {
        shared += Arena::round_up(model.header.size());
    }
    const std::size_t total = memory_.span().size();
    const std::size_t share = total > shared ? (total - shared) / models_.size() : 0;
    const auto cache = static_cast<std::size_t>(options.cache_mib * kBytesPerMib) / models_.size();
    for (std::size_t i = 0; i < models_.size(); ++i)
    {
        // Planned twice: what the courier needs follows from the number of pages.
        ModelCapacities capacities = plan_capacities(headers_[i], share, cache);
        const std::size_t courier =
            Courier::required_bytes(capacities.pages, capacities.index_pages);
        capacities = courier < share ? plan_capacities(headers_[i], share - courier, cache)
                                     : ModelCapacities{};
        if (capacities.pages == 0)
        {
            return Refusal{fmt::format(
                "--pool-mib: {} MiB is too small for model '{}' (its base mesh has {} faces); "
                "give more, or less --cache-mib",
                options.pool_mib, models_[i].name, headers_[i].counts().base_faces)};
        }
        sources_.push_back({models_[i].header, models_[i].base, capacities});
    }
    setup_.models = sources_;
    if (const auto started = Frame::start(frame_, arena_, setup_); !started)
    {
        return Refusal{
            fmt::format("--pool-mib: {} MiB: {}", options.pool_mib, refusal_text(started.error()))};
    }
    return std::nullopt;
}

void Controller::make_couriers(const Log& log)
{
    for (std::uint32_t i = 0; i < models_.size(); ++i)
    {
        Model& model = frame_->model({i});
        couriers_.push_back(std::make_unique<Courier>(arena_, model.header, model.slots,
                                                      model.linker, model.inbox, *models_[i].link,
                                                      models_[i].name, log));
    }
}

std::optional<Refusal> Controller::finish_devices(const Options& options)
{
    for (std::size_t tool = 0; tool < tools_.size(); ++tool)
    {
        if (tools_[tool].device == nullptr)
        {
            if (auto error = simulate_device(options, tool))
            {
                return error;
            }
        }
        limit_force(options, tools_[tool]);
    }
    return std::nullopt;
}

std::optional<Refusal> Controller::simulate_device(const Options& options, std::size_t tool)
{
    HandScene scene;
    scene.anchors_world_m = anchors_world_m();
    scene.diagonal_m = diagonal_world_m();
    scene.tool_radius_m = tools_[tool].spec.radius_m;
    scene.period = options.period();
    scene.frames_total = options.frames();
    auto motion = make_motion(options.motion, scene, tool + 1);
    if (!motion)
    {
        return Refusal{"--tool: " + motion.error().text};
    }
    SimulatedDeviceOptions device_options;
    device_options.rate_hz = options.rate_hz;
    device_options.device = choice_of(options, tool).limits;
    device_options.workspace_centre_world_m = motion.value().centre_world_m;
    device_options.workspace_radius_m = motion.value().reach_m;
    device_options.speed_max_m_per_s =
        std::max(device_options.speed_max_m_per_s, kHandSpeed_diag * diagonal_world_m());
    auto device = SimulatedDevice::create(device_options, std::move(motion.value().hand));
    if (!device)
    {
        return Refusal{"--device: " + device.error().text};
    }
    tools_[tool].device = std::move(device).value();
    if (!options.device_faults.empty())
    {
        tools_[tool].device = std::make_unique<FaultyDevice>(std::move(tools_[tool].device),
                                                             options.device_faults, tool);
    }
    return std::nullopt;
}

/// What stands between the tool's force and its device.
void Controller::limit_force(const Options& options, ToolSetup& tool) const
{
    const DeviceInfo& info = tool.device->info();
    ConditionerSetup& conditioner = tool.conditioner;
    conditioner.device = info.limits;
    conditioner.period_s = 1.0 / static_cast<double>(options.rate_hz);
    for (const ObjectSpec& object : objects_)
    {
        conditioner.surface_damping_max_n_s_per_m =
            std::max(conditioner.surface_damping_max_n_s_per_m, object.material.damping_n_s_per_m);
    }
    const double cap_n_per_m =
        stiffness_cap(info.limits, conditioner.period_s, conditioner.surface_damping_max_n_s_per_m);
    tool.limits = {options.speed_limit_m_per_s.value_or(info.speed_max_m_per_s),
                   info.limits.force_max_n, std::min(tool.spec.stiffness_n_per_m, cap_n_per_m),
                   kDampingShare * info.limits.damping_n_s_per_m};
}

/// The first model's base vertices: original vertices, so they lie on its surface.
std::vector<Vec3> Controller::anchors_world_m() const
{
    std::vector<Vec3> anchors;
    const ObjectPose pose = model_pose(poses_.front(), headers_.front().origin_m());
    for (const Vec3f& position_m : frame_->model({0}).slots.base.positions_m)
    {
        anchors.push_back(to_world(pose, to_vec3(position_m)));
    }
    return anchors;
}

} // namespace tactus::hrtc
