// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/world/world_plan.hpp"

#include "platform/choices/messages.hpp"
#include "platform/choices/option_ranges.hpp"
#include "platform/choices/tool_choice.hpp"
#include "platform/devices/remote/remote_values.hpp"
#include "platform/machine/posix/posix_clock.hpp"
#include "platform/readers/file_readers.hpp"
#include "platform/world/world_values.hpp"
#include "transport/base/number_form.hpp"
#include "transport/store/store_link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <utility>

namespace tactus
{

namespace
{

using hrtc::failure;
using hrtc::OptionRange;

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

/// Text of an option of hrtc and the function that sets it.
struct Words
{
    const char* part;
    const std::string& text;
    std::string (*setter)(const std::string&, hrtc::ToolOptions&);
};

/// Sets the options whose text is not empty. Returns the first fault; empty if there is none.
std::string set_by_words(hrtc::ToolOptions& made, std::initializer_list<Words> all)
{
    for (const Words& words : all)
    {
        const std::string fault = words.text.empty() ? "" : words.setter(words.text, made);
        if (!fault.empty())
        {
            return fmt::format("{}: {}", words.part, fault);
        }
    }
    return {};
}

} // namespace

std::string name_of_file(const std::string& path)
{
    return std::filesystem::path(path).stem().string();
}

WorldPlan::WorldPlan(std::int64_t rate_hz) : rate_hz_(rate_hz)
{
    options_.tools.clear();
    options_.readers = hrtc::file_readers();
}

Result<std::size_t, Refusal> WorldPlan::take_model(const WorldModel& model, bool is_open)
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
        if (!is_open) // Encoding takes long, and each mesh is a new model.
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
    if (!is_open)
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

void WorldPlan::forget_models_after(std::size_t count)
{
    options_.models.resize(count);
    has_published_ = has_published_ && count > 0;
    has_files_ = has_files_ && (count > 0 || !options_.scene.empty());
}

std::optional<Refusal> WorldPlan::fault_of_room(std::size_t model, std::uint32_t faces,
                                                bool is_open) const
{
    const auto& rooms = options_.edit_rooms;
    const std::uint32_t most = has_published_         ? 0
                               : is_open              ? hrtc::kEditFacesRange.high
                               : model < rooms.size() ? rooms[model]
                                                      : 0;
    return faces <= most ? std::nullopt
                         : std::optional(wrong_value(
                               fmt::format("edit_faces: {}; 0 to {} is allowed{}", faces, most,
                                           has_published_ ? " for a published model"
                                           : is_open      ? ""
                                                          : ", the room at the first frame")));
}

void WorldPlan::reserve_room(std::size_t model, std::uint32_t faces)
{
    options_.edit_rooms.resize(options_.models.size());
    options_.edit_rooms[model] = std::max(options_.edit_rooms[model], faces);
}

Result<std::vector<hrtc::PlacedObject>, Refusal> WorldPlan::take_scene(const std::string& path)
{
    auto scene = options_.readers.read_scene(path);
    if (!scene)
    {
        return scene.error();
    }
    options_.scene = path;
    has_files_ = true;
    for (hrtc::PlacedObject& object : scene.value().objects)
    {
        object.name =
            object.name.empty() ? name_of_file(scene.value().models[object.model]) : object.name;
    }
    return std::move(scene.value().objects);
}

Result<std::uint32_t, Refusal> WorldPlan::add_hand(const WorldTool& tool, const WorldDevice& device,
                                                   const HandOptions& options)
{
    if (options_.tools.size() == kMaxTools)
    {
        return failure(fmt::format("a World has at most {} hands", kMaxTools));
    }
    if (options.force && !options.fixture.empty())
    {
        return failure("a hand has a fixture or a force of the program, not both");
    }
    const std::size_t number = options_.tools.size();
    const std::size_t models = options_.models.size();
    hrtc::ToolOptions made;
    HandParts parts;
    for (const std::string& fault :
         {set_device(made, device, parts, number), set_shape(made, tool),
          set_by_words(made, {{"payload", options.payload, hrtc::set_tool_mass},
                              {"fixture", options.fixture, hrtc::set_tool_fixture},
                              {"edit", options.edit, hrtc::set_tool_edit}})})
    {
        if (!fault.empty())
        {
            forget_models_after(models);
            return failure(fault);
        }
    }
    if (options.force)
    {
        parts.force = std::make_unique<hrtc::CallbackForce>(
            options.force, nanoseconds(1'000'000'000 / std::max<std::int64_t>(rate_hz_, 1)));
        made.external_force = parts.force.get();
    }
    options_.tools.push_back(std::move(made));
    hands_.push_back(std::move(parts));
    return static_cast<std::uint32_t>(number);
}

/// Sets the tool's shape. Returns the fault; empty if there is none.
std::string WorldPlan::set_shape(hrtc::ToolOptions& made, const WorldTool& tool)
{
    auto shape = checked_shape(tool);
    if (!shape)
    {
        return shape.error().text;
    }
    made.shape = std::move(shape).value();
    if (!tool.model)
    {
        return take_named_mesh(made.mesh_model());
    }
    auto model = take_model(*tool.model, true);
    if (!model)
    {
        return "tool: " + model.error().text;
    }
    made.shape->mesh_model = options_.models[model.value()];
    made.shape->words = "mesh:" + name_of_file(made.shape->mesh_model);
    return {};
}

/// Takes the model that a tool's words name; empty: none. Returns the fault; empty if there is
/// none.
std::string WorldPlan::take_named_mesh(const std::string& name)
{
    const bool is_file = name.ends_with(".spm") || options_.readers.is_mesh_name(name);
    const auto model = name.empty()
                           ? Result<std::size_t, Refusal>(std::size_t{0})
                           : take_model(is_file ? model_file(name) : published(name), true);
    return model ? std::string() : "tool: " + model.error().text;
}

/// Sets the tool's device. Returns the fault; empty if there is none.
std::string WorldPlan::set_device(hrtc::ToolOptions& made, const WorldDevice& device,
                                  HandParts& parts, std::size_t hand)
{
    const DeviceOptions& options = device.options;
    if (!device.words.empty())
    {
        return set_by_words(made, {{"device", device.words, hrtc::set_tool_device},
                                   {"limits", options.limits, hrtc::set_tool_limits},
                                   {"frame", options.frame, hrtc::set_tool_frame},
                                   {"motion", options.motion, hrtc::set_tool_motion}});
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
    const std::string limits =
        set_by_words(made, {{"limits", options.limits, hrtc::set_tool_limits}});
    if (!limits.empty())
    {
        return limits;
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

std::optional<Refusal> WorldPlan::fault_of(const WorldOptions& asked) const
{
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

void WorldPlan::take_options(const WorldOptions& asked, bool is_stepped)
{
    hrtc::Options& options = options_;
    options.objects_max = asked.objects_max;
    options.transport = has_published_ ? hrtc::TransportKind::dds : hrtc::TransportKind::file;
    options.domain = asked.domain;
    options.is_watched = has_published_ || asked.is_watched;
    options.name = asked.name;
    options.follows_poses = asked.follows_poses;
    options.wait_s = asked.wait_s;
    options.rate_hz = asked.rate_hz;
    options.runs_until_stopped = is_stepped || !asked.duration_s;
    options.duration_s = asked.duration_s.value_or(hrtc::Options{}.duration_s);
    options.record_path = asked.record;
    options.trace_path = is_stepped ? "" : asked.trace;
    options.pool_mib = asked.memory_mib;
    options.static_when_it_fits = asked.loads_whole;
    options.stiffness_n_per_m = asked.stiffness_n_per_m;
    options.angular_stiffness_nm_per_rad = asked.angular_stiffness_nm_per_rad.value_or(0.0);
    options.shading_m = asked.shading_m.value_or(0.0);
    options.force_tolerance_n = asked.force_tolerance_n;
    options.speed_limit_m_per_s = asked.speed_limit_m_per_s;
    options.object_speed_m_per_s = asked.object_speed_m_per_s;
    options.clutch_button = asked.clutch_button;
    options.supervisor_periods = asked.supervisor_periods;
    options.proxy_speed_m_per_s = asked.proxy_speed_m_per_s;
    options.has_guardian = !is_stepped && !asked.has_no_guardian;
    options.thread.priority = asked.priority;
    options.thread.cpu = is_stepped ? std::nullopt : asked.cpu;
    options.thread.allow_no_rt = asked.allow_no_rt;
    options.is_stepped = is_stepped;
    options.virtual_time = is_stepped;
    options.thread.is_realtime = !is_stepped;
    options.thread.lock_memory = !is_stepped;
    options.thread.processors_awake = !is_stepped;
}

bool runs_in_real_time(const hrtc::ToolOptions& tool)
{
    const hrtc::DeviceKind kind = tool.device.kind;
    return kind == hrtc::DeviceKind::udp || kind == hrtc::DeviceKind::dhd ||
           kind == hrtc::DeviceKind::plugin;
}

CallbackCounts WorldPlan::callbacks() const
{
    CallbackCounts counts;
    for (const HandParts& hand : hands_)
    {
        counts.throws += hand.force != nullptr ? hand.force->throws() : 0;
        counts.overruns += hand.force != nullptr ? hand.force->overruns() : 0;
    }
    return counts;
}

void WorldPlan::let_go_of_devices()
{
    for (HandParts& hand : hands_)
    {
        hand.held = nullptr;
    }
}

} // namespace tactus
