// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/world/world_core.hpp"

#include "platform/choices/messages.hpp"
#include "platform/choices/option_ranges.hpp"
#include "platform/choices/tool_words.hpp"
#include "platform/devices/remote/info_fault.hpp"
#include "platform/loop/assertion_brake.hpp"
#include "platform/machine/posix/posix_clock.hpp"
#include "platform/readers/file_readers.hpp"
#include "platform/scene/material_limits.hpp"
#include "platform/scene/object_pose.hpp"
#include "platform/world/world_words.hpp"
#include "rt_core/math/rotation.hpp"
#include "transport/base/counted.hpp"
#include "transport/material_ranges.hpp"
#include "transport/store/store_link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <iterator>
#include <system_error>
#include <tuple>
#include <utility>
#include <variant>

namespace tactus
{

namespace
{

using hrtc::failure;
using hrtc::OptionRange;

constexpr const char* kOwnThread = "called from a callback or device of the World; call it on "
                                   "another thread";
constexpr const char* kHasEnded = "the World has ended; make a new one";

/// Refusal of a call from a callback or device, whose thread may hold the World's lock.
std::optional<Refusal> fault_of_thread(std::string_view call)
{
    return hrtc::is_in_callback() ? std::optional(failure(fmt::format("{}: {}", call, kOwnThread)))
                                  : std::nullopt;
}

/// Only one loop of a process can brake its devices when an assertion fails (AssertionBrake).
std::atomic<bool> has_loop{false};

/// Refusal of an argument or option out of its range.
Refusal wrong_value(std::string text)
{
    return {std::move(text), true};
}

Material material_of(const MaterialOptions& options)
{
    Material material;
    material.stiffness_n_per_m = options.stiffness_n_per_m.value_or(Material{}.stiffness_n_per_m);
    material.static_friction = options.static_friction;
    material.dynamic_friction = options.dynamic_friction.value_or(options.static_friction);
    material.damping_n_s_per_m = options.damping_n_s_per_m;
    material.viscosity_n_s_per_m = options.viscosity_n_s_per_m;
    material.texture_height_m = options.texture_height_m;
    material.texture_length_m = options.texture_length_m;
    return material;
}

Result<Material, Refusal> checked_material(const MaterialOptions& options)
{
    const Material material = material_of(options);
    return is_in_range(material) ? Result<Material, Refusal>(material)
                                 : wrong_value(fmt::format("material: out of range; allowed are {}",
                                                           kMaterialRanges));
}

Result<Similarity, Refusal> checked_place(const Pose& pose)
{
    const auto checked = checked_pose(pose);
    if (!checked)
    {
        return wrong_value(fmt::format(
            "pose: {} is out of range; allowed are a unit quaternion, a translation within {} m "
            "and a scale of {} to {}",
            kPoseRefusalNames[static_cast<std::size_t>(checked.error())], kPoseReachMax_m,
            kPoseScaleMin, kPoseScaleMax));
    }
    return hrtc::to_similarity(checked.value());
}

std::optional<Refusal> fault_of(const HandPose& pose)
{
    const bool is_near = std::ranges::all_of(pose.position_m, [](double x)
                                             { return std::abs(x) < kGoalRange_m; }); // NaN fails.
    if (!is_near)
    {
        return wrong_value(fmt::format("position_m: ({}, {}, {}); each must be within {} m",
                                       pose.position_m[0], pose.position_m[1], pose.position_m[2],
                                       kGoalRange_m));
    }
    return is_unit(pose.rotation, kRotationTolerance)
               ? std::nullopt
               : std::optional(
                     wrong_value(fmt::format("rotation: ({}, {}, {}, {}) is no quaternion of "
                                             "length 1 within {}",
                                             pose.rotation[0], pose.rotation[1], pose.rotation[2],
                                             pose.rotation[3], kRotationTolerance)));
}

/// Fault of an option outside of its range; empty if it is in it or not given.
template <typename Number, typename Limit>
std::string fault_in(const char* name, const std::optional<Number>& value,
                     const OptionRange<Limit>& range)
{
    const bool is_in = !value || (static_cast<double>(*value) >= static_cast<double>(range.low) &&
                                  static_cast<double>(*value) <= static_cast<double>(range.high));
    return is_in ? std::string()
                 : fmt::format("{}: {}; {} to {} is allowed", name, *value, range.low, range.high);
}

/// True for a device whose samples have the machine's time, and which needs the guards of start().
bool runs_in_real_time(const hrtc::ToolOptions& tool)
{
    const hrtc::DeviceKind kind = tool.device.kind;
    return kind == hrtc::DeviceKind::udp || kind == hrtc::DeviceKind::dhd ||
           kind == hrtc::DeviceKind::plugin;
}

std::string name_of_file(const std::string& path)
{
    return std::filesystem::path(path).stem().string();
}

} // namespace

WorldCore::WorldCore(WorldOptions options) : asked_(std::move(options))
{
    options_.tools.clear();
    options_.readers = hrtc::file_readers();
}

WorldCore::~WorldCore()
{
    is_stopping_.store(true);
    join_keeper();
    if (phase_.load() == Phase::stepped)
    {
        static_cast<void>(session_->finish());
    }
}

template <typename Handle>
Handle WorldCore::handle_or_refusal(Result<Handle, Refusal> made)
{
    if (made)
    {
        return std::move(made).value();
    }
    Refusal refusal = hrtc::in_world_words(made.error());
    if (!first_refusal_ && phase_.load() == Phase::open)
    {
        first_refusal_ = refusal;
    }
    return refused_handle<Handle>(std::move(refusal));
}

template <typename Handle>
Handle WorldCore::refused_handle(Refusal refusal)
{
    Handle handle;
    handle.world_ = weak_from_this();
    handle.refused_ = std::make_shared<const Refusal>(std::move(refusal));
    return handle;
}

WorldObject WorldCore::handle_of(std::uint32_t number, std::uint32_t generation)
{
    WorldObject object;
    object.world_ = weak_from_this();
    object.number_ = number;
    object.generation_ = generation;
    return object;
}

// --- Parts ---------------------------------------------------------------------------------------

WorldObject WorldCore::add(const WorldModel& model, const ObjectOptions& options)
{
    if (auto fault = fault_of_thread("add()"))
    {
        return refused_handle<WorldObject>(*std::move(fault));
    }
    const std::lock_guard lock(mutex_);
    return handle_or_refusal(try_add(model, options));
}

WorldObject WorldCore::add(const WorldObject& like, const ObjectOptions& options)
{
    if (auto fault = fault_of_thread("add()"))
    {
        return refused_handle<WorldObject>(*std::move(fault));
    }
    const std::lock_guard lock(mutex_);
    const auto model = model_of(like);
    return handle_or_refusal(model ? place(model.value(), options)
                                   : Result<WorldObject, Refusal>(model.error()));
}

/// Index of the model that another object shows; the handle may be of any state and World.
Result<std::size_t, Refusal> WorldCore::model_of(const WorldObject& like) const
{
    if (auto refusal = why_not_change(like, "add()"))
    {
        return *std::move(refusal);
    }
    if (like.world_.lock().get() != this)
    {
        return failure("add(): the handle is of no object of this World");
    }
    if (phase_.load() == Phase::open)
    {
        return like.number_ < options_.objects.size()
                   ? Result<std::size_t, Refusal>(options_.objects[like.number_].model)
                   : failure("add(): a World with a scene has no other objects at the start");
    }
    const auto model = scene_->model_of({like.number_, like.generation_});
    return model ? Result<std::size_t, Refusal>(std::size_t{model->value})
                 : failure("add(): the object was removed");
}

Hand WorldCore::add(const WorldTool& tool, const WorldDevice& device, const HandOptions& options)
{
    if (auto fault = fault_of_thread("add()"))
    {
        return refused_handle<Hand>(*std::move(fault));
    }
    const std::lock_guard lock(mutex_);
    return handle_or_refusal(try_add(tool, device, options));
}

std::vector<WorldObject> WorldCore::add_scene(const std::string& path)
{
    if (auto fault = fault_of_thread("add_scene()"))
    {
        return {refused_handle<WorldObject>(*std::move(fault))};
    }
    const std::lock_guard lock(mutex_);
    std::vector<WorldObject> objects;
    const auto refuse = [&](Refusal refusal)
    { objects.push_back(handle_or_refusal<WorldObject>(std::move(refusal))); };
    if (phase_.load() != Phase::open || !options_.objects.empty() || !options_.models.empty())
    {
        refuse(failure(fmt::format("{}: a scene is added first, before the World runs, and brings "
                                   "all objects of the start",
                                   path)));
        return objects;
    }
    auto scene = options_.readers.read_scene(path);
    if (!scene)
    {
        refuse(scene.error());
        return objects;
    }
    options_.scene = path;
    has_files_ = true;
    const std::lock_guard naming(names_mutex_);
    for (const hrtc::PlacedObject& object : scene.value().objects)
    {
        const auto number = static_cast<std::uint32_t>(objects.size());
        names_[number] =
            object.name.empty() ? name_of_file(scene.value().models[object.model]) : object.name;
        objects.push_back(handle_of(number, 0));
    }
    return objects;
}

std::optional<Refusal> WorldCore::error() const
{
    if (auto fault = fault_of_thread("error()"))
    {
        return fault;
    }
    const std::lock_guard lock(mutex_);
    return first_refusal_;
}

/// Index of the model in the options; a file or a mesh is read first.
Result<std::size_t, Refusal> WorldCore::take_model(const WorldModel& model)
{
    std::string name = model.text;
    const bool is_published = model.kind == WorldModel::Kind::published;
    if (is_published)
    {
        if (const auto selector = parse_selector(name); !selector)
        {
            return selector.error();
        }
    }
    else if (model.kind != WorldModel::Kind::file)
    {
        if (phase_.load() != Phase::open) // Encoding takes long, and each mesh is a new model.
        {
            return failure("the World runs; add each mesh before the first frame, and further "
                           "objects of it by their handles");
        }
        auto encoded = meshes_.encode(model);
        if (!encoded)
        {
            return encoded.error();
        }
        name = std::move(encoded).value();
    }
    else if (options_.readers.is_mesh_name(name))
    {
        return failure(fmt::format("{}: a mesh; add it by mesh_file()", name));
    }
    const auto known = std::ranges::find(options_.models, name);
    if (known != options_.models.end())
    {
        return static_cast<std::size_t>(known - options_.models.begin());
    }
    if (phase_.load() != Phase::open)
    {
        return failure(fmt::format(
            "{}: the World runs and has no such model; add each model before the first frame",
            name));
    }
    if ((is_published && has_files_) || (!is_published && has_published_))
    {
        return failure(
            fmt::format("{}: models of files and of servers can't be in one World", name));
    }
    if (options_.models.size() == kMaxModels)
    {
        return failure(fmt::format("{}: a World has at most {} models", name, kMaxModels));
    }
    if (!is_published)
    {
        if (const auto opened = serve_from_file(name, "model", hrtc::log_line); !opened)
        {
            return opened.error();
        }
    }
    has_published_ = has_published_ || is_published;
    has_files_ = has_files_ || !is_published;
    options_.models.push_back(name);
    return options_.models.size() - 1;
}

Result<WorldObject, Refusal> WorldCore::try_add(const WorldModel& model,
                                                const ObjectOptions& options)
{
    if (!options_.scene.empty() && phase_.load() == Phase::open)
    {
        return failure("a World with a scene has no other objects at the start");
    }
    const auto taken = take_model(model);
    return taken ? place(taken.value(), options) : Result<WorldObject, Refusal>(taken.error());
}

/// Adds an object of a known model: to the options before the start, to the scene later.
Result<WorldObject, Refusal> WorldCore::place(std::size_t model, const ObjectOptions& options)
{
    const auto place = checked_place(options.pose);
    if (!place)
    {
        return place.error();
    }
    const auto material = checked_material(options.material);
    if (!material)
    {
        return material.error();
    }
    const Phase phase = phase_.load();
    hrtc::ProgramScene::Key key{static_cast<std::uint32_t>(options_.objects.size()), 0};
    if (phase == Phase::ended)
    {
        return failure(kHasEnded);
    }
    if (phase == Phase::open)
    {
        if (options_.objects.size() == kMaxObjects)
        {
            return failure(fmt::format("a World has at most {} objects", kMaxObjects));
        }
        options_.objects.push_back({.model = model,
                                    .place = place.value(),
                                    .material = material.value(),
                                    .has_place = true,
                                    .has_material = true,
                                    .name = options.name});
    }
    else
    {
        const auto& controller = session_->controller();
        const std::string& name = controller.models()[model].name;
        if (hrtc::is_of_tool(controller.tools(), model))
        {
            return failure(
                fmt::format("'{}' is the model of a tool; an object needs its own", name));
        }
        if (auto why = hrtc::why_unfelt(name, material.value(), controller.tools()))
        {
            return failure(*why);
        }
        const auto added = scene_->try_add(
            {ModelId{static_cast<std::uint32_t>(model)}, material.value()}, place.value());
        if (!added)
        {
            return failure(fmt::format("objects_max: {} are there already; use a larger value",
                                       counted(controller.frame().objects().capacity(), "object")));
        }
        key = *added;
    }
    const std::string of_model = phase == Phase::open ? name_of_file(options_.models[model])
                                                      : session_->controller().models()[model].name;
    if (phase != Phase::open)
    {
        session_->name_object(key.number, options.name);
    }
    const std::lock_guard lock(names_mutex_);
    names_[key.number] = options.name.empty() ? of_model : options.name;
    return handle_of(key.number, key.generation);
}

Result<Hand, Refusal> WorldCore::try_add(const WorldTool& tool, const WorldDevice& device,
                                         const HandOptions& options)
{
    if (phase_.load() != Phase::open)
    {
        return failure("the World runs; add each hand before the first frame");
    }
    if (options_.tools.size() == kMaxTools)
    {
        return failure(fmt::format("a World has at most {} hands", kMaxTools));
    }
    if (options.force && !options.fixture.empty())
    {
        return failure("a hand has a fixture or a force of the program, not both");
    }
    const std::size_t number = options_.tools.size();
    hrtc::ToolOptions made;
    HandParts parts;
    const auto set = [&](const char* part, const std::string& text,
                         std::string (*setter)(const std::string&, hrtc::ToolOptions&))
    {
        const std::string fault = text.empty() ? "" : setter(text, made);
        return fault.empty() ? "" : fmt::format("{}: {}", part, fault);
    };
    for (const std::string& fault : {set_device(made, device, parts, number), set_shape(made, tool),
                                     set("payload", options.payload, hrtc::set_tool_mass),
                                     set("fixture", options.fixture, hrtc::set_tool_fixture)})
    {
        if (!fault.empty())
        {
            return failure(fault);
        }
    }
    if (options.force)
    {
        parts.force = std::make_unique<hrtc::CallbackForce>(
            options.force, nanoseconds(1'000'000'000 / std::max<std::int64_t>(asked_.rate_hz, 1)));
        made.external_force = parts.force.get();
    }
    options_.tools.push_back(std::move(made));
    hands_.push_back(std::move(parts));
    Hand hand;
    hand.world_ = weak_from_this();
    hand.number_ = static_cast<std::uint32_t>(number);
    return hand;
}

/// Sets the tool's shape. Returns the fault; empty if there is none.
std::string WorldCore::set_shape(hrtc::ToolOptions& made, const WorldTool& tool)
{
    if (!tool.words.empty())
    {
        const std::string fault = hrtc::set_tool_shape(tool.words, made);
        return fault.empty() ? take_named_mesh(made.mesh_model()) : "tool: " + fault;
    }
    hrtc::ToolChoice& shape = made.shape.emplace();
    shape.radius_m = tool.radius_m;
    if (!(tool.radius_m >= 0.0 && tool.radius_m <= 1.0))
    {
        return fmt::format("tool: radius {} m; 0 to 1 is allowed", tool.radius_m);
    }
    if (tool.model)
    {
        auto model = take_model(*tool.model);
        if (!model)
        {
            return "tool: " + model.error().text;
        }
        shape.mesh_model = options_.models[model.value()];
        shape.words = "mesh:" + name_of_file(shape.mesh_model);
        return {};
    }
    std::vector<Vec3> corners;
    for (const auto& [x, y, z] : tool.corners)
    {
        corners.emplace_back(x, y, z);
    }
    if (corners.empty() ||
        !std::ranges::all_of(corners, [](const Vec3& corner) { return corner.allFinite(); }))
    {
        return "tool: a hull needs corners, all of them finite";
    }
    shape.words = fmt::format("hull of {}", counted(corners.size(), "corner"));
    const auto refusal = hrtc::set_hull(shape, corners, "tool");
    return refusal ? refusal->text : std::string();
}

/// Takes the model that a tool's words name; empty: none. Returns the fault; empty if there is
/// none.
std::string WorldCore::take_named_mesh(const std::string& name)
{
    const bool is_file = name.ends_with(".spm") || options_.readers.is_mesh_name(name);
    const auto model = name.empty() ? Result<std::size_t, Refusal>(std::size_t{0})
                                    : take_model(is_file ? model_file(name) : published(name));
    return model ? std::string() : "tool: " + model.error().text;
}

/// Sets the tool's device. Returns the fault; empty if there is none.
std::string WorldCore::set_device(hrtc::ToolOptions& made, const WorldDevice& device,
                                  HandParts& parts, std::size_t hand)
{
    const DeviceOptions& options = device.options;
    if (!device.words.empty())
    {
        for (const auto& [part, text, setter] :
             {std::tuple("device", &device.words, &hrtc::set_tool_device),
              std::tuple("limits", &options.limits, &hrtc::set_tool_limits),
              std::tuple("frame", &options.frame, &hrtc::set_tool_frame),
              std::tuple("motion", &options.motion, &hrtc::set_tool_motion)})
        {
            const std::string fault = text->empty() ? "" : setter(*text, made);
            if (!fault.empty())
            {
                return fmt::format("{}: {}", part, fault);
            }
        }
        return {};
    }
    if (device.own == nullptr && !device.is_program)
    {
        return "device: neither words nor an object; by_program() is a hand without a device";
    }
    if (!options.frame.empty() || !options.motion.empty() ||
        (device.own != nullptr && !options.limits.empty()))
    {
        return "device: a device of the program has no frame and no motion, and its own limits";
    }
    if (!options.limits.empty())
    {
        const std::string fault = hrtc::set_tool_limits(options.limits, made);
        if (!fault.empty())
        {
            return "limits: " + fault;
        }
    }
    const char* const fault = device.own != nullptr ? find_fault(device.own->info()) : nullptr;
    if (fault != nullptr)
    {
        return fault;
    }
    parts.own = device.own;
    parts.is_held = device.own == nullptr;
    made.device.kind = hrtc::DeviceKind::program;
    made.device.make = [this, hand,
                        limits =
                            made.device.limits]() -> Result<std::unique_ptr<HapticDevice>, Refusal>
    {
        HandParts& of_hand = hands_[hand];
        if (of_hand.own != nullptr)
        {
            return std::unique_ptr<HapticDevice>(std::make_unique<hrtc::SharedDevice>(of_hand.own));
        }
        auto held = std::make_unique<hrtc::HeldDevice>(limits);
        of_hand.held = held.get();
        if (of_hand.first_pose)
        {
            held->hold(of_hand.first_pose->position_m, of_hand.first_pose->rotation,
                       PosixClock().now());
        }
        return std::unique_ptr<HapticDevice>(std::move(held));
    };
    return {};
}

// --- Start and end -------------------------------------------------------------------------------

std::optional<Refusal> WorldCore::check_options() const
{
    const WorldOptions& asked = asked_;
    using namespace hrtc;
    const auto all = [](auto value) { return std::optional(value); };
    for (const std::string& fault :
         {fault_in("rate_hz", all(asked.rate_hz), kRateRange_hz),
          fault_in("memory_mib", all(asked.memory_mib), kPoolRange_mib),
          fault_in("stiffness_n_per_m", all(asked.stiffness_n_per_m), kStiffnessRange_n_per_m),
          fault_in("angular_stiffness_nm_per_rad", asked.angular_stiffness_nm_per_rad,
                   kAngularStiffnessRange_nm_per_rad),
          fault_in("shading_m", asked.shading_m, kShadingRange_m),
          fault_in("force_tolerance_n", all(asked.force_tolerance_n), kForceToleranceRange_n),
          fault_in("object_speed_m_per_s", all(asked.object_speed_m_per_s),
                   kObjectSpeedRange_m_per_s),
          fault_in("proxy_speed_m_per_s", asked.proxy_speed_m_per_s, kProxySpeedRange_m_per_s),
          fault_in("speed_limit_m_per_s", asked.speed_limit_m_per_s, kSpeedLimitRange_m_per_s),
          fault_in("clutch_button", asked.clutch_button, kClutchRange),
          fault_in("objects_max", all(asked.objects_max),
                   OptionRange<std::uint32_t>{0, kMaxObjects}),
          fault_in("wait_s", all(asked.wait_s), kWaitRange_s),
          fault_in("domain", all(asked.domain), kDomainRange),
          fault_in("duration_s", asked.duration_s, kDurationRange_s),
          fault_in("priority", all(asked.priority),
                   OptionRange<int>{RtThreadOptions::kPriorityMin, RtThreadOptions::kPriorityMax}),
          fault_in("cpu", asked.cpu, kCpuRange),
          fault_in("supervisor_periods", asked.supervisor_periods, kSupervisorRange)})
    {
        if (!fault.empty())
        {
            return wrong_value(fault);
        }
    }
    if (asked.shading_m && std::ranges::none_of(options_.tools, &is_round))
    {
        return wrong_value("shading_m: needs a point or a sphere as a tool");
    }
    const auto objects = static_cast<std::uint32_t>(options_.objects.size());
    if (asked.objects_max != 0 && asked.objects_max < objects)
    {
        return wrong_value(fmt::format("objects_max: {} is less than the {} at the start",
                                       asked.objects_max, counted(objects, "object")));
    }
    return asked.name.empty() || is_valid_name(asked.name)
               ? std::nullopt
               : std::optional(
                     wrong_value(fmt::format("name: '{}' is not {}", asked.name, kNameForm)));
}

/// Takes the World's options over into those of a run.
void WorldCore::take_options(bool is_stepped)
{
    hrtc::Options& options = options_;
    options.objects_max = asked_.objects_max;
    options.transport = has_published_ ? hrtc::TransportKind::dds : hrtc::TransportKind::file;
    options.domain = asked_.domain;
    options.is_watched = has_published_ || asked_.is_watched;
    options.name = asked_.name;
    options.follows_poses = asked_.follows_poses;
    options.wait_s = asked_.wait_s;
    options.rate_hz = asked_.rate_hz;
    options.runs_until_stopped = is_stepped || !asked_.duration_s;
    options.duration_s = asked_.duration_s.value_or(hrtc::Options{}.duration_s);
    options.record_path = asked_.record;
    options.trace_path = is_stepped ? "" : asked_.trace;
    options.pool_mib = asked_.memory_mib;
    options.static_when_it_fits = asked_.loads_whole;
    options.stiffness_n_per_m = asked_.stiffness_n_per_m;
    options.angular_stiffness_nm_per_rad = asked_.angular_stiffness_nm_per_rad.value_or(0.0);
    options.shading_m = asked_.shading_m.value_or(0.0);
    options.force_tolerance_n = asked_.force_tolerance_n;
    options.speed_limit_m_per_s = asked_.speed_limit_m_per_s;
    options.object_speed_m_per_s = asked_.object_speed_m_per_s;
    options.clutch_button = asked_.clutch_button;
    options.supervisor_periods = asked_.supervisor_periods;
    options.proxy_speed_m_per_s = asked_.proxy_speed_m_per_s;
    options.has_guardian = !is_stepped && !asked_.has_no_guardian;
    options.thread.priority = asked_.priority;
    options.thread.cpu = is_stepped ? std::nullopt : asked_.cpu;
    options.thread.allow_no_rt = asked_.allow_no_rt;
    options.is_stepped = is_stepped;
    options.virtual_time = is_stepped;
    options.thread.is_realtime = !is_stepped;
    options.thread.lock_memory = !is_stepped;
    options.thread.processors_awake = !is_stepped;
}

/// Reason why a call that begins or needs frames is refused.
std::optional<Refusal> WorldCore::why_not(std::string_view call) const
{
    if (phase_.load() == Phase::ended)
    {
        return failure(fmt::format("{}: {}", call, kHasEnded));
    }
    if (first_refusal_)
    {
        return first_refusal_;
    }
    if (options_.tools.empty())
    {
        return failure(fmt::format("{}: the World has no hand; add one first", call));
    }
    if (options_.objects.empty() && options_.scene.empty())
    {
        return failure(fmt::format("{}: the World has no object; add one first", call));
    }
    return std::nullopt;
}

/// Opens models and devices, and makes what the loop shares with the program. A refusal changes
/// nothing.
std::optional<Refusal> WorldCore::open(bool is_stepped)
{
    try
    {
        return try_open(is_stepped);
    }
    catch (const std::exception& exception) // Too little memory, or no more threads.
    {
        close();
        return failure(fmt::format("the World can't begin: {}", exception.what()));
    }
}

std::optional<Refusal> WorldCore::try_open(bool is_stepped)
{
    if (auto refusal = check_options())
    {
        return refusal;
    }
    const auto real = std::ranges::find_if(options_.tools, &runs_in_real_time);
    if (is_stepped && real != options_.tools.end())
    {
        return failure(fmt::format("step(): the device of hand {} runs in real time; use start()",
                                   real - options_.tools.begin()));
    }
    take_options(is_stepped);
    std::error_code unread;
    const auto threads =
        std::distance(std::filesystem::directory_iterator("/proc/self/task", unread),
                      std::filesystem::directory_iterator());
    const bool forks =
        options_.has_guardian &&
        std::ranges::any_of(options_.tools, hrtc::wants_guard, &hrtc::ToolOptions::device);
    if (forks && threads > 2) // The caller, which waits, and the keeper, which forks.
    {
        return failure("device: its guardian is a fork, so start the World before other threads, "
                       "or set has_no_guardian");
    }
    hrtc::RunHooks hooks;
    hooks.is_stopped = [this]
    {
        tell_of_callbacks();
        return is_stopping_.load();
    };
    auto session = hrtc::Session::open(options_, std::move(hooks));
    if (!session)
    {
        close();
        return hrtc::in_world_words(session.error());
    }
    session_ = std::move(session).value();
    const hrtc::Controller& controller = session_->controller();
    scene_ = std::make_unique<hrtc::ProgramScene>(controller.scene_parts(), controller.poses());
    tap_ = std::make_unique<hrtc::HandTap>(controller.tools().size());
    is_served_.assign(controller.objects().size(), false);
    for (const std::uint32_t first : controller.first_objects())
    {
        const bool is_moved = has_published_ && asked_.follows_poses;
        if (is_moved && first < is_served_.size())
        {
            is_served_[first] = true;
        }
    }
    if (auto refusal = session_->start(scene_.get(), tap_.get()))
    {
        close();
        return hrtc::in_world_words(*refusal);
    }
    return std::nullopt;
}

/// Undoes a refused open().
void WorldCore::close()
{
    release();
    tap_.reset();
    scene_.reset();
}

/// Closes models, devices and network. The last states stay.
void WorldCore::release()
{
    session_.reset();
    for (HandParts& hand : hands_)
    {
        hand.held = nullptr;
    }
}

Result<Done, Refusal> WorldCore::start()
{
    if (const auto fault = fault_of_thread("start()"))
    {
        return *fault;
    }
    const std::lock_guard lock(mutex_);
    if (const auto refusal = why_not("start()"))
    {
        return *refusal;
    }
    if (phase_.load() != Phase::open)
    {
        return failure(phase_.load() == Phase::running
                           ? "start(): the loop runs already"
                           : "start(): the program runs this World by step()");
    }
    if (has_loop.exchange(true))
    {
        return failure("start(): another World of this process runs its loop; stop it first");
    }
    std::promise<std::optional<Refusal>> decided;
    auto decision = decided.get_future();
    is_stopping_.store(false);
    try
    {
        const std::lock_guard joining(joining_);
        keeper_ = std::thread([this, decided = std::move(decided)]() mutable
                              { keep_loop(std::move(decided)); });
    }
    catch (const std::system_error& error)
    {
        has_loop.store(false);
        return failure(fmt::format("start(): no thread can be started: {}", error.what()));
    }
    if (const auto refusal = decision.get())
    {
        join_keeper();
        has_loop.store(false);
        return *refusal;
    }
    return Done{};
}

/// Body of the keeper's thread, which starts all others and ends them.
void WorldCore::keep_loop(std::promise<std::optional<Refusal>> decided)
{
    hrtc::install_assertion_brake();
    auto refusal = open(false);
    const bool is_refused = refusal.has_value();
    phase_.store(is_refused ? Phase::open : Phase::running);
    decided.set_value(std::move(refusal));
    if (is_refused)
    {
        return;
    }
    session_->running().wait("World");
    hrtc::FinishedRun done = session_->finish();
    const std::lock_guard lock(mutex_);
    done_ = std::move(done);
    release();
    has_loop.store(false); // Another World may start as soon as this one is seen to have ended.
    phase_.store(Phase::ended);
}

Result<Done, Refusal> WorldCore::wait()
{
    if (const auto fault = fault_of_thread("wait()"))
    {
        return *fault;
    }
    join_keeper();
    const std::lock_guard lock(mutex_);
    return finished();
}

Result<Done, Refusal> WorldCore::stop()
{
    if (const auto fault = fault_of_thread("stop()"))
    {
        return *fault;
    }
    is_stopping_.store(true); // Also ends the wait of start() and wait() on other threads.
    join_keeper();
    const std::lock_guard lock(mutex_);
    if (phase_.load() == Phase::stepped)
    {
        done_ = session_->finish();
        release();
        phase_.store(Phase::ended);
    }
    return finished();
}

/// Waits for the end of the loop of start(), if there is one; without mutex_, so that handles work
/// meanwhile.
void WorldCore::join_keeper()
{
    const std::lock_guard joining(joining_);
    if (keeper_.joinable())
    {
        keeper_.join();
    }
}

/// Result of a run that has ended, if one has.
Result<Done, Refusal> WorldCore::finished() const
{
    if (!done_)
    {
        return failure("nothing has run");
    }
    if (done_->recording_error)
    {
        return failure("record: " + *done_->recording_error);
    }
    if (done_->trace_error)
    {
        return failure("trace: " + *done_->trace_error);
    }
    return done_->has_other_device
               ? Result<Done, Refusal>(failure("another device took the place of a hand's device"))
               : Done{};
}

// --- Frames --------------------------------------------------------------------------------------

Result<Done, Refusal> WorldCore::step(double dt_s)
{
    if (const auto fault = fault_of_thread("step()"))
    {
        return *fault;
    }
    const std::lock_guard lock(mutex_);
    return run_step(dt_s, std::nullopt, {});
}

Result<HandState, Refusal> WorldCore::step(std::uint32_t hand, const HandPose& pose, double dt_s)
{
    if (const auto fault = fault_of_thread("step()"))
    {
        return *fault;
    }
    const std::lock_guard lock(mutex_);
    const auto done = run_step(dt_s, hand, pose);
    return done ? Result<HandState, Refusal>(tap_->last(hand)) : done.error();
}

/// Runs the next frame, after a hand was moved to the pose. With mutex_.
Result<Done, Refusal> WorldCore::run_step(double dt_s, std::optional<std::uint32_t> hand,
                                          const HandPose& pose)
{
    if (const auto refusal = why_not("step()"))
    {
        return *refusal;
    }
    if (phase_.load() == Phase::running)
    {
        return failure("step(): the loop of start() runs this World; read its state()");
    }
    if (!(dt_s >= 0.0 && std::isfinite(dt_s)))
    {
        return wrong_value(fmt::format("dt_s: {}; 0 or more is allowed", dt_s));
    }
    if (hand && !hands_[*hand].is_held)
    {
        return failure("step(): a device moves this hand; call World::step()");
    }
    if (const auto fault = hand ? fault_of(pose) : std::nullopt)
    {
        return *fault;
    }
    if (phase_.load() == Phase::open)
    {
        is_stopping_.store(false); // Set by a stop() before anything ran.
        if (const auto refusal = open(true))
        {
            return *refusal;
        }
        phase_.store(Phase::stepped);
    }
    const auto rate = static_cast<double>(asked_.rate_hz);
    const auto periods = static_cast<std::int64_t>(std::clamp(std::round(dt_s * rate), 1.0, rate));
    hrtc::SessionRun& run = session_->running();
    const MonotonicTime time = run.now() + options_.period() * periods;
    for (std::uint32_t i = 0; i < hands_.size(); ++i)
    {
        if (hand == i)
        {
            hands_[i].held->hold(pose.position_m, pose.rotation, time);
        }
        else if (hands_[i].held != nullptr)
        {
            hands_[i].held->keep_until(time);
        }
    }
    run.step(static_cast<std::uint32_t>(periods));
    tell_of_callbacks();
    return Done{};
}

Result<Done, Refusal> WorldCore::hold(std::uint32_t hand, const HandPose& pose)
{
    if (const auto fault = fault_of_thread("hold()"))
    {
        return *fault;
    }
    if (const auto fault = fault_of(pose))
    {
        return *fault;
    }
    const std::lock_guard lock(mutex_);
    HandParts& parts = hands_[hand];
    if (!parts.is_held)
    {
        return failure("hold(): a device moves this hand");
    }
    switch (phase_.load())
    {
    case Phase::open:
        parts.first_pose = pose;
        return Done{};
    case Phase::running:
        parts.held->hold(pose.position_m, pose.rotation, PosixClock().now());
        return Done{};
    case Phase::stepped:
        parts.held->hold(pose.position_m, pose.rotation, session_->running().now());
        return Done{};
    case Phase::ended:
        break;
    }
    return failure(fmt::format("hold(): {}", kHasEnded));
}

// --- Objects -------------------------------------------------------------------------------------

/// Reason why an object can't be changed; its handle may be of any state. With mutex_.
std::optional<Refusal> WorldCore::why_not_change(const WorldObject& object,
                                                 std::string_view call) const
{
    if (object.refused_ != nullptr)
    {
        return *object.refused_;
    }
    if (phase_.load() == Phase::ended)
    {
        return failure(fmt::format("{}: {}", call, kHasEnded));
    }
    return std::nullopt;
}

/// Reason why an object of a server is the server's to move. With mutex_.
std::optional<Refusal> WorldCore::why_served(const WorldObject& object, std::string_view call) const
{
    const bool is_served =
        object.generation_ == 0 && object.number_ < is_served_.size() && is_served_[object.number_];
    return is_served ? std::optional(failure(
                           fmt::format("{}: a server moves '{}'; set follows_poses to false", call,
                                       name_of(object.number_))))
                     : std::nullopt;
}

Result<Done, Refusal> WorldCore::move(const WorldObject& object, const Pose& pose)
{
    const auto place = checked_place(pose);
    if (!place)
    {
        return place.error();
    }
    if (const auto fault = fault_of_thread("move()"))
    {
        return *fault;
    }
    const std::lock_guard lock(mutex_);
    if (const auto refusal = why_not_change(object, "move()"))
    {
        return *refusal;
    }
    if (phase_.load() == Phase::open)
    {
        if (object.number_ >= options_.objects.size())
        {
            return failure("move(): the file of a scene places its objects until the first frame");
        }
        options_.objects[object.number_].place = place.value();
        return Done{};
    }
    if (const auto refusal = why_served(object, "move()"))
    {
        return *refusal;
    }
    return scene_->try_move({object.number_, object.generation_}, place.value())
               ? Result<Done, Refusal>(Done{})
               : failure("move(): the object was removed");
}

Result<Done, Refusal> WorldCore::feel(const WorldObject& object, const MaterialOptions& options)
{
    const auto material = checked_material(options);
    if (!material)
    {
        return material.error();
    }
    if (const auto fault = fault_of_thread("feel()"))
    {
        return *fault;
    }
    const std::lock_guard lock(mutex_);
    if (const auto refusal = why_not_change(object, "feel()"))
    {
        return *refusal;
    }
    if (phase_.load() == Phase::open)
    {
        if (object.number_ >= options_.objects.size())
        {
            return failure("feel(): the file of a scene has its materials until the first frame");
        }
        options_.objects[object.number_].material = material.value();
        return Done{};
    }
    if (auto why = hrtc::why_unfelt(name_of(object.number_), material.value(),
                                    session_->controller().tools()))
    {
        return failure(*why);
    }
    return scene_->try_feel({object.number_, object.generation_}, material.value())
               ? Result<Done, Refusal>(Done{})
               : failure("feel(): the object was removed");
}

Result<Done, Refusal> WorldCore::remove(const WorldObject& object)
{
    if (const auto fault = fault_of_thread("remove()"))
    {
        return *fault;
    }
    const std::lock_guard lock(mutex_);
    if (const auto refusal = why_not_change(object, "remove()"))
    {
        return *refusal;
    }
    if (phase_.load() == Phase::open)
    {
        return failure("remove(): an object leaves after the first frame; before it, don't add it");
    }
    if (const auto refusal = why_served(object, "remove()"))
    {
        return *refusal; // The server's poses would move the next object of this number.
    }
    return scene_->try_remove({object.number_, object.generation_})
               ? Result<Done, Refusal>(Done{})
               : failure("remove(): the object was removed before");
}

// --- State ---------------------------------------------------------------------------------------

HandState WorldCore::state(std::uint32_t hand) const noexcept
{
    const Phase phase = phase_.load();
    if (phase == Phase::open)
    {
        return {};
    }
    HandState state = tap_->state(hand);
    if (phase == Phase::ended)
    {
        state.force_n = {};
        state.torque_nm = {};
        state.withheld = Withheld::ended;
    }
    return state;
}

std::string WorldCore::why(std::uint32_t hand, const HandState& state) const
{
    if (state.withheld == Withheld::overlap)
    {
        return fmt::format("hand {} overlaps '{}' since one of them came: no force until it is "
                           "clear",
                           hand, name_of(state.withheld_object));
    }
    if (state.withheld == Withheld::nothing && state.began_inside)
    {
        return fmt::format("hand {} began inside a closed object, whose surface keeps it inside",
                           hand);
    }
    return text_of(state.withheld);
}

WorldCounts WorldCore::counts() const
{
    WorldCounts counts;
    if (phase_.load() == Phase::open)
    {
        return counts;
    }
    const hrtc::LoopCounts loop = tap_->counts();
    counts.frames = loop.frames;
    counts.missed = loop.missed;
    counts.overruns = loop.overruns;
    counts.latency_misses = loop.latency_misses;
    counts.brakes = tap_->brakes();
    for (const HandParts& hand : hands_) // It no longer changes.
    {
        counts.callback_throws += hand.force != nullptr ? hand.force->throws() : 0;
        counts.callback_overruns += hand.force != nullptr ? hand.force->overruns() : 0;
    }
    return counts;
}

std::string WorldCore::name_of(std::uint32_t object) const
{
    const std::lock_guard lock(names_mutex_);
    const auto found = names_.find(object);
    return found != names_.end() ? found->second : fmt::format("object {}", object);
}

/// Logs throws and overruns of callbacks at the first one, at ten, at a hundred, and so on. Thread
/// that watches the loop.
void WorldCore::tell_of_callbacks()
{
    std::uint64_t throws = 0;
    std::uint64_t overruns = 0;
    for (const HandParts& hand : hands_)
    {
        throws += hand.force != nullptr ? hand.force->throws() : 0;
        overruns += hand.force != nullptr ? hand.force->overruns() : 0;
    }
    if (throws >= std::max<std::uint64_t>(10 * told_throws_, 1))
    {
        told_throws_ = throws;
        hrtc::log_line(fmt::format("a force callback has thrown, {}: its force was zero",
                                   counted(throws, "time")));
    }
    if (overruns >= std::max<std::uint64_t>(10 * told_overruns_, 1))
    {
        told_overruns_ = overruns;
        hrtc::log_line(fmt::format("a force callback took longer than a period, {}",
                                   counted(overruns, "time")));
    }
}

} // namespace tactus
