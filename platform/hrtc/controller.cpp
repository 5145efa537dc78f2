// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/controller.hpp"

#include "platform/hrtc/object_pose.hpp"
#include "platform/simulated/hand_motions.hpp"
#include "platform/simulated/simulated_device.hpp"
#include "rt_core/force/angular_stiffness.hpp"
#include "rt_core/force/stiffness_rule.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::hrtc
{

namespace
{

constexpr double kBytesPerMib = 1024.0 * 1024.0;
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
    controller->make_courier(log);
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

std::vector<std::uint32_t> Controller::first_objects() const
{
    std::vector<std::uint32_t> first;
    for (std::uint32_t i = 0; i < models_.size(); ++i)
    {
        const auto shows = std::ranges::find(objects_, ModelId{i}, &ObjectSpec::model);
        first.push_back(static_cast<std::uint32_t>(shows - objects_.begin()));
    }
    return first;
}

void Controller::make_poses(const Options& options)
{
    for (const PlacedObject& object : options.objects)
    {
        poses_.push_back(object_pose(object.place, headers_[object.model]));
        objects_.push_back({ModelId{static_cast<std::uint32_t>(object.model)}, object.material});
    }
}

/// Those that aren't simulated; before the tools, which need to know what the devices can do.
std::optional<Refusal> Controller::open_devices(const Options& options,
                                                const std::function<bool()>& goes_on)
{
    tools_.resize(options.tools);
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
    std::vector<ToolChoice> choices = options.tool_choices;
    choices.resize(tools_.size(), default_tool(diagonal_world_m()));
    for (std::size_t i = 0; i < tools_.size(); ++i)
    {
        ToolSetup& tool = tools_[i];
        const DeviceLimits limits =
            tool.device != nullptr ? tool.device->info().limits : choice_of(options, i).limits;
        tool.shape = choices[i].words;
        tool.spec = {choices[i].radius_m, options.stiffness_n_per_m, limits.force_max_n,
                     options.follow_speed_m_per_s.value_or(kSpeedMax_diag * diagonal_world_m())};
        tool.spec.core = choices[i].core;
        const auto* mesh = std::get_if<MeshCore>(&tool.spec.core);
        tool.hand_radius_m =
            hand_radius_m(choices[i], mesh != nullptr ? &headers_[mesh->model.value] : nullptr,
                          diagonal_world_m());
        tool.spec.torque_max_nm = limits.turn.torque_max_nm;
        tool.spec.angular_stiffness_nm_per_rad = options.angular_stiffness_nm_per_rad;
        tool_specs_.push_back(tool.spec);
    }
}

/// What belongs to no model comes off first.
std::optional<Refusal> Controller::lay_out_pools(const Options& options)
{
    setup_.objects = objects_;
    setup_.poses = poses_;
    setup_.capacities.objects = options.objects_max;
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
    const auto cache = static_cast<std::size_t>(options.cache_mib * kBytesPerMib);
    std::vector<ModelCapacities> capacities(models_.size());
    // Planned twice: what the courier needs follows from the number of pages.
    bool fits = shared < total && try_plan(headers_, total - shared, cache, capacities);
    const ModelCapacities sum = sum_of(capacities);
    shared += fits ? Courier::required_bytes(sum.pages, sum.index_pages) : 0;
    fits = fits && shared < total && try_plan(headers_, total - shared, cache, capacities);
    if (!fits)
    {
        std::uint32_t base_faces = 0;
        for (const ModelHeader& header : headers_)
        {
            base_faces += header.counts().base_faces;
        }
        return Refusal{fmt::format("--pool-mib: {} MiB is too small for {} models (their base "
                                   "meshes have {} faces); give more, or less --cache-mib",
                                   options.pool_mib, models_.size(), base_faces)};
    }
    for (std::size_t i = 0; i < models_.size(); ++i)
    {
        sources_.push_back({models_[i].header, models_[i].base, capacities[i]});
    }
    setup_.models = sources_;
    if (const auto started = Frame::start(frame_, arena_, setup_); !started)
    {
        return Refusal{
            fmt::format("--pool-mib: {} MiB: {}", options.pool_mib, refusal_text(started.error()))};
    }
    return std::nullopt;
}

void Controller::make_courier(const Log& log)
{
    ModelPools& pools = frame_->pools();
    courier_.emplace(arena_, pools.slots, pools.cache.door, log);
    for (std::uint32_t i = 0; i < models_.size(); ++i)
    {
        Model& model = frame_->model({i});
        courier_->add(model.header, model.linker, *models_[i].link, models_[i].name);
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
        tools_[tool].spec = frame_->tool(static_cast<std::uint32_t>(tool)).spec();
        limit_force(options, tools_[tool]);
    }
    return std::nullopt;
}

std::optional<Refusal> Controller::simulate_device(const Options& options, std::size_t tool)
{
    HandScene scene;
    scene.anchors_world_m = anchors_world_m();
    scene.diagonal_m = diagonal_world_m();
    scene.tool_radius_m = tools_[tool].hand_radius_m;
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
                   kDampingShare * info.limits.damping_n_s_per_m, info.limits.turn.torque_max_nm};
    if (info.limits.turn.torque_max_nm > 0.0)
    {
        const DeviceLimits turning = turning_of(info.limits);
        tool.limits.stiffness_nm_per_rad = std::min(angular_stiffness_nm_per_rad(tool.spec),
                                                    stiffness_cap(turning, conditioner.period_s));
        tool.limits.damping_nm_s_per_rad = kDampingShare * turning.damping_n_s_per_m;
    }
    tool.clutch_button = options.clutch_button;
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
