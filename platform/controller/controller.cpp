// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/controller/controller.hpp"

#include "platform/choices/fixture.hpp"
#include "platform/choices/run_options.hpp"
#include "platform/controller/following_operator.hpp"
#include "platform/devices/simulated/operator_motions.hpp"
#include "platform/devices/simulated/simulated_device.hpp"
#include "platform/machine/pool_memory.hpp"
#include "platform/scene/material_limits.hpp"
#include "rt_core/base/arena.hpp"
#include "rt_core/force/angular_stiffness.hpp"
#include "rt_core/frame/frame.hpp"
#include "rt_core/limits.hpp"
#include "transport/base/number_form.hpp"
#include "transport/base_fetch.hpp"
#include "transport/chunk_loader.hpp"
#include "transport/pool_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <utility>

namespace tactus::hrtc
{

namespace
{

/// Share of the largest accepted tolerance that a refusal proposes, so that it is accepted when
/// rounded to three digits.
constexpr double kWithinRadius = 0.99;

constexpr double kBytesPerMib = 1024.0 * 1024.0;
/// Speed limit of the proxy without --proxy-speed, in diagonals of the first object per second.
constexpr double kSpeedMax_diag = 1.0;
/// Speed limit of a simulated device, in diagonals of its object per second.
constexpr double kOperatorSpeed_diag = 4.0;
/// Share of that limit at which an operator that follows an object catches up.
constexpr double kCatchUpShare = 0.5;
/// Largest share of a device's force or torque that a payload may take, so that walls can still be
/// felt. Messages call it "half".
constexpr double kPayloadShareMax = 0.5;
/// Least diagonal of an object that is chosen for a simulated operator, in radii of its tool. If no
/// object is so large, the first one is chosen.
constexpr double kOperatorRoom = 10.0;

/// Rounds up to two decimals, so that the printed value is never less than `value`.
double up_to_cents(double value)
{
    return std::ceil(100.0 * value) / 100.0;
}

} // namespace

struct Controller::Core
{
    explicit Core(std::size_t bytes) : memory(bytes), arena(memory.span()) {}

    PoolMemory memory;
    Arena arena;
    std::optional<Frame> frame;
    std::optional<ChunkLoader> chunk_loader;
};

Result<std::unique_ptr<Controller>, Refusal>
Controller::create(const Options& options, std::vector<ServedModel> models, const Log& log,
                   const std::function<bool()>& goes_on)
{
    std::unique_ptr<Controller> controller(new Controller(std::move(models), goes_on));
    controller->budgets_.splits = options.splits;
    controller->budgets_.merges = options.splits;
    controller->budgets_.work = options.frame_work();
    controller->make_poses(options);
    if (std::optional<Refusal> error = controller->open_devices(options))
    {
        return *error;
    }
    controller->make_tools(options);
    if (std::optional<Refusal> error = controller->check_tolerance(options))
    {
        return *error;
    }
    if (std::optional<Refusal> error = controller->lay_out_pools(options))
    {
        return *error;
    }
    controller->make_chunk_loader(log);
    if (std::optional<Refusal> error = controller->finish_devices(options))
    {
        return *error;
    }
    return controller;
}

Controller::Controller(std::vector<ServedModel> models, const std::function<bool()>& goes_on)
    : goes_on_(goes_on), models_(std::move(models))
{
    for (const ServedModel& model : models_)
    {
        headers_.push_back(ModelHeader::parse(model.header).value());
    }
}

Controller::~Controller() = default;

Frame& Controller::frame() noexcept
{
    return *core_->frame;
}

const Frame& Controller::frame() const noexcept
{
    return *core_->frame;
}

const ObjectTable& Controller::object_table() const noexcept
{
    return frame().objects();
}

PagePool& Controller::page_pool() noexcept
{
    return frame().pools().cache.pages;
}

ChunkLoader& Controller::chunk_loader() noexcept
{
    return *core_->chunk_loader;
}

const ChunkLoader& Controller::chunk_loader() const noexcept
{
    return *core_->chunk_loader;
}

std::size_t Controller::pool_bytes() const noexcept
{
    return core_->arena.used() + sizeof(Frame);
}

double Controller::diagonal_world_m() const noexcept
{
    return diagonal_of(0);
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

SceneParts Controller::scene_parts() const
{
    return {models_, objects_, tools_, first_objects(), object_table().capacity()};
}

void Controller::make_poses(const Options& options)
{
    for (const PlacedObject& object : options.objects)
    {
        poses_.push_back(object_pose(object.place, headers_[object.model]));
        objects_.push_back({ModelId{static_cast<std::uint32_t>(object.model)}, object.material});
    }
}

/// Opens the devices that aren't simulated. Called before the tools, which need the devices'
/// limits.
std::optional<Refusal> Controller::open_devices(const Options& options)
{
    tools_.resize(options.tools.size());
    const DeviceWait wait{milliseconds(static_cast<std::int64_t>(options.wait_s * 1e3)), goes_on_,
                          options.rate_hz};
    for (std::size_t i = 0; i < options.tools.size(); ++i)
    {
        const DeviceChoice& choice = options.tools[i].device;
        if (choice.kind == DeviceKind::simulated)
        {
            continue;
        }
        auto device = open_device(choice, i, wait, clock_);
        if (!device)
        {
            return Refusal{options.of_tool("--device", i) + ": " + device.error().text};
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
    for (std::size_t i = 0; i < tools_.size(); ++i)
    {
        ToolSetup& tool = tools_[i];
        const ToolOptions& asked = options.tools[i];
        const ToolChoice shape = asked.shape.value_or(default_tool(diagonal_world_m()));
        const DeviceLimits limits =
            tool.device != nullptr ? tool.device->info().limits : asked.device.limits;
        tool.shape = shape.words;
        tool.spec = {shape.radius_m, options.stiffness_n_per_m, limits.force_max_n,
                     options.proxy_speed_m_per_s.value_or(kSpeedMax_diag * diagonal_world_m())};
        tool.spec.core = shape.core;
        const auto* mesh = std::get_if<MeshCore>(&tool.spec.core);
        tool.operator_radius_m = operator_radius_m(
            shape, mesh != nullptr ? &headers_[mesh->model.value] : nullptr, diagonal_world_m());
        tool.external_force = asked.external_force;
        if (asked.fixture)
        {
            fixtures_.push_back(std::make_unique<VirtualFixture>(*asked.fixture));
            tool.external_force = fixtures_.back().get();
            tool.fixture = asked.fixture->words;
        }
        tool.spec.torque_max_nm = limits.rotation.torque_max_nm;
        tool.spec.angular_stiffness_nm_per_rad = options.angular_stiffness_nm_per_rad;
        tool.spec.shading_m = Tool::is_held_as_rigid(tool.spec) ? 0.0 : options.shading_m;
        tool_specs_.push_back(tool.spec);
    }
}

/// Refuses a force tolerance at which a surface may be off by more than a tool's radius: the tool
/// would feel no force there. The usual tolerance is always accepted. Tools without a radius, and
/// mesh tools, are not checked.
std::optional<Refusal> Controller::check_tolerance(const Options& options) const
{
    const double asked_n = options.force_tolerance_n;
    double softest_n_per_m = options.stiffness_n_per_m;
    for (const ObjectSpec& object : objects_)
    {
        const double wall_n_per_m = object.material.stiffness_n_per_m;
        softest_n_per_m =
            wall_n_per_m > 0.0 ? std::min(softest_n_per_m, wall_n_per_m) : softest_n_per_m;
    }
    for (const ToolSetup& tool : tools_)
    {
        const double most_n = softest_n_per_m * tool.spec.radius_m;
        if (!is_mesh(tool.spec) && tool.spec.radius_m > 0.0 &&
            asked_n > std::max(most_n, kForceToleranceUsual_n))
        {
            return Refusal{
                fmt::format("--force-tolerance: {:.3g} N is {:.3g} mm at a stiffness of {:.4g} "
                            "N/m, more than the radius of the tool {}; use 0 to {:.3g} N",
                            asked_n, 1e3 * asked_n / softest_n_per_m, softest_n_per_m, tool.shape,
                            std::max(kWithinRadius * most_n, kForceToleranceUsual_n))};
        }
    }
    return std::nullopt;
}

std::optional<Refusal> Controller::lay_out_pools(const Options& options)
{
    setup_.objects = objects_;
    setup_.poses = poses_;
    setup_.capacities.objects = options.objects_max;
    setup_.tools = tool_specs_;
    if (!options.scene.empty())
    {
        setup_.capacities.pairs =
            std::min(capacities_of(setup_).pairs, SceneRoom::of(options.pool_bytes()).pairs);
    }
    setup_.static_when_it_fits = options.static_when_it_fits;
    setup_.prediction = options.prediction;
    setup_.force_tolerance_n = options.force_tolerance_n;
    setup_.kernels = options.kernels != nullptr ? options.kernels : &best_kernels();
    setup_.period_ns = options.period().ns;
    const auto cache = static_cast<std::size_t>(options.cache_mib * kBytesPerMib);
    const std::size_t most = options.pool_bytes() - sizeof(Frame);
    std::vector<ModelCapacities> capacities(models_.size());
    std::vector<std::uint32_t> edit_faces;
    for (std::size_t i = 0; i < models_.size(); ++i)
    {
        // A file without edits, or a model of a server without them, gets none.
        const std::uint32_t room = models_[i].edit_room;
        edit_faces.push_back(room > 0 ? options.edit_faces.value_or(room) : 0);
        capacities[i].edit_faces = edit_faces.back();
    }
    const bool fits = try_plan_pools(setup_, headers_, most, cache, capacities);
    if (!fits && !try_plan_as_streamed_models(options, most, cache))
    {
        const std::size_t least =
            least_pool_bytes(setup_, headers_, cache, edit_faces) + sizeof(Frame);
        return Refusal{
            fmt::format("--pool-mib: {} MiB is too small for {}; at least {:.2f} MiB is needed{}",
                        options.pool_mib, counted(models_.size(), "model"),
                        up_to_cents(static_cast<double>(least) / kBytesPerMib),
                        options.cache_mib > 0.0 ? ", or a smaller --cache-mib" : "")};
    }
    if (fits)
    {
        if (auto error = fetch_bases(models_, options))
        {
            return error;
        }
    }
    for (std::size_t i = 0; i < models_.size() && fits; ++i)
    {
        sources_.push_back({models_[i].header, models_[i].base, capacities[i]});
    }
    setup_.models = sources_;
    const ModelCapacities sum = pool_capacities(setup_);
    core_ = std::make_unique<Core>(Frame::required_bytes(setup_) +
                                   ChunkLoader::required_bytes(sum.pages, sum.index_pages));
    if (const auto started = Frame::start(core_->frame, core_->arena, setup_); !started)
    {
        return Refusal{
            fmt::format("--pool-mib: {} MiB: {}", options.pool_mib, refusal_text(started.error()))};
    }
    return std::nullopt;
}

/// Fetches the missing base meshes of these models.
std::optional<Refusal> Controller::fetch_bases(std::span<ServedModel> models,
                                               const Options& options) const
{
    const auto wait = std::chrono::milliseconds(static_cast<std::int64_t>(options.wait_s * 1e3));
    return fetch_base_meshes(models, wait, goes_on_);
}

/// Plans the pools of a scene for streamed models, which need not all be resident at once. False,
/// without effect, if there is no scene, a tool is a mesh or the pools are too small.
bool Controller::try_plan_as_streamed_models(const Options& options, std::size_t bytes,
                                             std::size_t cache)
{
    if (options.scene.empty() || std::ranges::any_of(tool_specs_, &is_mesh))
    {
        return false;
    }
    for (const ServedModel& model : models_)
    {
        sources_.push_back({model.header, {}, {}});
    }
    setup_.models = sources_;
    if (try_plan_streamed_models(setup_, headers_, bytes, cache, setup_.for_streamed_models))
    {
        return true;
    }
    sources_.clear();
    setup_.models = {};
    setup_.for_streamed_models = {};
    return false;
}

void Controller::make_chunk_loader(const Log& log)
{
    ModelPools& pools = frame().pools();
    ChunkLoaderOptions options;
    options.forgotten_ns =
        std::max(options.forgotten_ns, 3 * kRequestTimeoutFrames * setup_.period_ns);
    core_->chunk_loader.emplace(core_->arena, pools.slots, pools.cache.queues, log, options);
    for (std::uint32_t i = 0; i < models_.size(); ++i)
    {
        Model& model = frame().model({i});
        chunk_loader().add(model.header, model.linker, *models_[i].link, models_[i].name);
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
        tools_[tool].spec = frame().tool(static_cast<std::uint32_t>(tool)).spec();
        limit_force(options, tools_[tool]);
        if (auto error = hang_load(options, tool))
        {
            return error;
        }
    }
    if (auto error = check_grippers(options))
    {
        return error;
    }
    return check_damping(options);
}

/// Refuses a gripper fixture on a device without gripper force.
std::optional<Refusal> Controller::check_grippers(const Options& options) const
{
    for (std::size_t i = 0; i < options.tools.size(); ++i)
    {
        const DeviceInfo& device = tools_[i].device->info();
        const std::optional<FixtureChoice>& fixture = options.tools[i].fixture;
        if (fixture && fixture->kind == FixtureKind::gripper && !(device.gripper_force_max_n > 0.0))
        {
            return Refusal{fmt::format("{}: '{}': the device {} has no gripper force",
                                       options.of_tool("--fixture", i), fixture->words,
                                       device.name)};
        }
    }
    return std::nullopt;
}

/// Sets the tool's payload. Refuses one above kPayloadShareMax of the device's force or torque.
std::optional<Refusal> Controller::hang_load(const Options& options, std::size_t tool)
{
    ToolLoad& load = tools_[tool].load;
    if (options.tools[tool].load.mass_kg == 0.0)
    {
        return std::nullopt;
    }
    load = options.tools[tool].load;
    load.down_world = options.tools[tool].device.frame.rotation * load.down_world;
    const std::string option = options.of_tool("--tool-mass", tool);
    const DeviceInfo& device = tools_[tool].device->info();
    const double torque_max_nm = device.limits.rotation.torque_max_nm;
    if (load.weight_n() > kPayloadShareMax * device.limits.force_max_n)
    {
        return Refusal{fmt::format(
            "{}: {:.4g} kg weigh {:.3g} N; the device {} carries at most "
            "half of its {:.3g} N, which is {:.3g} kg",
            option, load.mass_kg, load.weight_n(), device.name, device.limits.force_max_n,
            kPayloadShareMax * device.limits.force_max_n / kGravity_m_per_s2)};
    }
    if (torque_max_nm > 0.0 && load.torque_max_nm() > kPayloadShareMax * torque_max_nm)
    {
        return Refusal{fmt::format("{}: {:.4g} kg at {:.3g} m cause a torque of {:.3g} N m; the "
                                   "device {} carries at most half of its {:.3g} N m",
                                   option, load.mass_kg, load.centre_m.norm(), load.torque_max_nm(),
                                   device.name, torque_max_nm)};
    }
    return std::nullopt;
}

/// Refuses an object whose damping leaves a tool's device no perceptible stiffness. Materials of a
/// server are limited during the run instead.
std::optional<Refusal> Controller::check_damping(const Options& options) const
{
    const bool is_served = options.transport == TransportKind::dds && !options.scene.empty();
    for (std::size_t i = 0; i < objects_.size() && !is_served; ++i)
    {
        const ObjectSpec& object = objects_[i];
        if (const auto why = why_unfelt(models_[object.model.value].name, object.material, tools_))
        {
            return Refusal{
                fmt::format("{}: {}", options.scene.empty() ? "--material" : "--scene", *why)};
        }
    }
    return std::nullopt;
}

std::optional<Refusal> Controller::simulate_device(const Options& options, std::size_t tool)
{
    const auto chosen = object_of_operator(options, tool);
    if (!chosen)
    {
        return chosen.error();
    }
    const std::size_t object = chosen.value();
    if (auto error = fetch_bases({&models_[objects_[object].model.value], 1}, options))
    {
        return error;
    }
    OperatorScene scene;
    scene.anchors_world_m = anchors_world_m(object);
    if (scene.anchors_world_m.empty())
    {
        return Refusal{fmt::format("model '{}': its base mesh is damaged",
                                   models_[objects_[object].model.value].name)};
    }
    scene.diagonal_m = diagonal_of(object);
    scene.tool_radius_m = tools_[tool].operator_radius_m;
    scene.period = options.period();
    scene.frames_total = options.frames();
    scene.operators_before =
        static_cast<std::size_t>(std::ranges::count(operator_objects_, object));
    operator_objects_.push_back(object);
    const ToolOptions& asked = options.tools[tool];
    auto motion = make_motion(asked.simulated.motion, scene, tool + 1);
    if (!motion)
    {
        return Refusal{options.of_tool("--tool", tool) + ": " + motion.error().text};
    }
    SimulatedDeviceOptions device_options;
    device_options.rate_hz = options.rate_hz;
    device_options.device = asked.device.limits;
    device_options.load = asked.load;
    device_options.workspace_centre_world_m = motion.value().centre_world_m;
    device_options.workspace_radius_m = motion.value().reach_m;
    device_options.speed_max_m_per_s =
        std::max(device_options.speed_max_m_per_s, kOperatorSpeed_diag * scene.diagonal_m);
    if (is_followed(options, object))
    {
        device_options.workspace_radius_m = kPoseReachMax_m;
        motion.value().motion = std::make_unique<FollowingOperator>(
            std::move(motion.value().motion), frame().objects(), static_cast<std::uint32_t>(object),
            model_pose(poses_[object], headers_[objects_[object].model.value].origin_m()),
            kCatchUpShare * kOperatorSpeed_diag * scene.diagonal_m * to_seconds(options.period()));
    }
    auto device = SimulatedDevice::create(device_options, std::move(motion.value().motion));
    if (!device)
    {
        return Refusal{options.of_tool("--device", tool) + ": " + device.error().text};
    }
    tools_[tool].device = std::move(device).value();
    if (!options.device_faults.empty())
    {
        tools_[tool].device = std::make_unique<FaultyDevice>(std::move(tools_[tool].device),
                                                             options.device_faults, tool);
    }
    return std::nullopt;
}

/// Sets the tool's part of the force pipeline from its device's properties and the options.
void Controller::limit_force(const Options& options, ToolSetup& tool) const
{
    const DeviceInfo& info = tool.device->info();
    const PipelineSetup setup =
        pipeline_setup(tool.spec, info.limits, 1.0 / static_cast<double>(options.rate_hz),
                       options.speed_limit_m_per_s.value_or(info.speed_max_m_per_s));
    tool.conditioner = setup.conditioner;
    tool.limits = setup.limits;
    tool.change.slew_share_per_ms = options.slew_share_per_ms;
    tool.change.object_speed_max_m_per_s = options.object_speed_m_per_s;
    tool.clutch_button = options.clutch_button;
}

/// Number of the object of a simulated operator. Without a name each operator gets another object,
/// if enough objects are much larger than its tool.
Result<std::size_t, Refusal> Controller::object_of_operator(const Options& options,
                                                            std::size_t tool) const
{
    if (const std::string& name = options.tools[tool].simulated.object; !name.empty())
    {
        const auto called = std::ranges::find(options.objects, name, &PlacedObject::name);
        if (called != options.objects.end())
        {
            return static_cast<std::size_t>(called - options.objects.begin());
        }
        const auto shows = [&](const ObjectSpec& object)
        { return models_[object.model.value].name == name; };
        const auto found = std::ranges::find_if(objects_, shows);
        if (found != objects_.end())
        {
            return static_cast<std::size_t>(found - objects_.begin());
        }
        std::set<std::string> names;
        for (const PlacedObject& object : options.objects)
        {
            names.insert(object.name.empty() ? models_[object.model].name : object.name);
        }
        return Refusal{options.of_tool("--motion", tool) + ": " +
                       no_such_object(name, std::vector<std::string>(names.begin(), names.end()))};
    }
    for (std::size_t i = 0; i < objects_.size(); ++i)
    {
        const std::size_t object = (tool + i) % objects_.size();
        if (diagonal_of(object) >= kOperatorRoom * tools_[tool].operator_radius_m)
        {
            return object;
        }
    }
    return 0;
}

bool Controller::is_followed(const Options& options, std::size_t object) const
{
    const bool may_move = options.transport == TransportKind::dds && options.follows_poses;
    return may_move &&
           (!options.scene.empty() ||
            std::ranges::count(first_objects(), static_cast<std::uint32_t>(object)) > 0);
}

double Controller::diagonal_of(std::size_t object) const noexcept
{
    return headers_[objects_[object].model.value].diagonal_m() * poses_[object].scale;
}

/// Base vertices of the object's model in the world. They are vertices of the source mesh, so they
/// lie on its surface. Empty if the base mesh is damaged.
std::vector<Vec3> Controller::anchors_world_m(std::size_t object) const
{
    std::vector<Vec3> anchors;
    const ModelId model = objects_[object].model;
    const ObjectPose pose = model_pose(poses_[object], headers_[model.value].origin_m());
    const ModelHeader& header = headers_[model.value];
    const ModelCounts counts = header.counts();
    std::vector<Vec3f> positions_m(counts.base_vertices);
    std::vector<BaseFace> faces(counts.base_faces);
    std::vector<std::uint32_t> next(counts.base_faces);
    if (!parse_base_mesh(models_[model.value].base, header, {positions_m, faces, next}))
    {
        return {};
    }
    for (const Vec3f& position_m : positions_m)
    {
        anchors.push_back(to_world(pose, to_vec3(position_m)));
    }
    return anchors;
}

} // namespace tactus::hrtc
