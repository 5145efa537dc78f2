// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/export/field_sink.hpp"
#include "rt_core/records/prediction.hpp"

#include <array>
#include <cmath>
#include <span>
#include <string>
#include <variant>

namespace tactus
{

namespace
{

constexpr std::array kFeatureNames{"corner_0", "corner_1", "corner_2", "edge_0",
                                   "edge_1",   "edge_2",   "interior"};
constexpr std::array kSideNames{"unsigned", "outside", "inside"};
/// Names in the order of ToolCore's kinds.
constexpr std::array kCoreNames{"point", "segment", "box", "hull", "body", "mesh"};
static_assert(kCoreNames.size() == std::variant_size_v<ToolCore>);
constexpr std::array kChangeNames{"object_comes", "object_moves", "object_goes",
                                  "tool_comes",   "tool_goes",    "object_feels"};
static_assert(kChangeNames.size() == kSceneChangeKinds);

template <typename Enum, std::size_t N>
const char* name_of(const std::array<const char*, N>& names, Enum value)
{
    return names.at(static_cast<std::size_t>(value));
}

std::vector<std::string> names_of(FrameFault faults)
{
    std::vector<std::string> names;
    for (std::size_t bit = 0; bit < kFrameFaults; ++bit)
    {
        if (has_fault(faults, static_cast<FrameFault>(1U << bit)))
        {
            names.emplace_back(kFrameFaultNames[bit]);
        }
    }
    return names;
}

template <typename Id>
std::optional<std::int64_t> known(Id id)
{
    return id.is_none() ? std::nullopt : std::optional<std::int64_t>(id.value);
}

template <typename T>
std::optional<T> where(bool is_so, const T& value)
{
    return is_so ? std::optional<T>(value) : std::nullopt;
}

/// Quaternion of a matrix; none if the matrix is no rotation, which a faulty device may send.
std::optional<Eigen::Quaterniond> quaternion(const Mat3& rotation)
{
    const Eigen::Quaterniond turned(rotation);
    const double norm = turned.norm();
    return where(std::isfinite(norm) && norm > 0.0, turned.normalized());
}

/// Number of events of this kind that a frame took from the queues.
std::int64_t count_of(std::span<const QueueEvent> events, QueueEventKind kind)
{
    std::int64_t count = 0;
    for (const QueueEvent& event : events)
    {
        count += event.kind == kind ? 1 : 0;
    }
    return count;
}

void tell_pose(FieldSink& sink, const std::optional<ObjectPose>& pose)
{
    sink.vector("translation_world_m",
                pose ? std::optional<Vec3>(pose->translation_m) : std::nullopt);
    sink.rotation("rotation_world", pose ? quaternion(pose->rotation) : std::nullopt);
    sink.number("scale", pose ? std::optional(pose->scale) : std::nullopt);
}

void tell_material(FieldSink& sink, const std::optional<Material>& material)
{
    const auto value = [&](double Material::*which)
    { return material ? std::optional((*material).*which) : std::nullopt; };
    sink.number("stiffness_n_per_m", value(&Material::stiffness_n_per_m));
    sink.number("static_friction", value(&Material::static_friction));
    sink.number("dynamic_friction", value(&Material::dynamic_friction));
    sink.number("damping_n_s_per_m", value(&Material::damping_n_s_per_m));
    sink.number("viscosity_n_s_per_m", value(&Material::viscosity_n_s_per_m));
    sink.number("texture_height_m", value(&Material::texture_height_m));
    sink.number("texture_length_m", value(&Material::texture_length_m));
}

void tell_work(FieldSink& sink, const WorkCounters& work)
{
    sink.integer("splits", work.splits);
    sink.integer("merges", work.merges);
    sink.integer("scanned", work.scanned);
    sink.integer("nodes_visited", work.nodes_visited);
    sink.integer("triangles_tested", work.triangles_tested);
    sink.integer("pages_adopted", work.pages_adopted);
    sink.integer("requests", work.requests);
    sink.integer("regions_searched", work.regions_searched);
    sink.integer("nodes_refitted", work.nodes_refitted);
    sink.integer("blocks_refitted", work.blocks_refitted);
    sink.integer("evictions", work.evictions);
    sink.integer("cache_hits", work.cache_hits);
    sink.integer("cache_misses", work.cache_misses);
    for (std::size_t i = 0; i < kSkips; ++i)
    {
        const std::string name = std::string("skipped_") + kSkipNames[i];
        sink.integer(name.c_str(), work.skipped.times()[i]);
    }
}

void tell_budgets(FieldSink& sink, const Budgets& budgets)
{
    sink.integer("budget_splits", budgets.splits);
    sink.integer("budget_merges", budgets.merges);
    sink.integer("budget_scanned", budgets.scanned);
    sink.integer("budget_nodes", budgets.nodes);
    sink.integer("budget_triangles", budgets.triangles);
    sink.integer("budget_pages", budgets.pages);
    sink.integer("budget_requests", budgets.requests);
    sink.integer("budget_regions", budgets.regions);
    sink.integer("budget_work", budgets.work);
}

/// Writes the device's input and output.
void tell_device(FieldSink& sink, const ToolState& state, const DeviceRecord& device)
{
    sink.flag("valid", state.valid);
    sink.integer("sample_time_ns", where(state.sample_time_ns != 0, state.sample_time_ns));
    sink.integer("elapsed_periods", state.elapsed_periods);
    sink.flag("connected", device.connected);
    sink.flag("deadman_held", device.deadman_held);
    sink.integer("buttons", device.buttons);
    sink.number("gripper_m", device.gripper_m);
    sink.vector("device_world_m", state.position_m);
    sink.rotation("device_rotation_world", quaternion(state.rotation));
    sink.vector("clutched_device_world_m",
                device.pose ? std::optional<Vec3>(device.pose->position_m) : std::nullopt);
    sink.rotation("clutched_device_rotation_world",
                  device.pose ? quaternion(device.pose->rotation) : std::nullopt);
    sink.vector("velocity_world_m_per_s", device.velocity_m_per_s);
    sink.vector("angular_velocity_world_rad_per_s", device.angular_velocity_rad_per_s);
    sink.vector("sent_force_world_n", device.sent_n);
    sink.vector("sent_torque_world_nm", device.sent_nm);
    sink.number("sent_gripper_n", device.sent_gripper_n);
}

} // namespace

void tell_run(FieldSink& sink, const RecordedSetup& setup)
{
    sink.integer("period_ns", setup.period_ns);
    sink.integer("pose_age_max_ns", setup.pose_age_max_ns);
    sink.flag("static_when_it_fits", setup.static_when_it_fits);
    sink.text("prediction", kPredictionNames.at(static_cast<std::size_t>(setup.prediction)));
    sink.number("force_tolerance_n", setup.force_tolerance_n);
    sink.text("compiler", setup.compiler);
    sink.text("architecture", setup.architecture);
    sink.text("kernels", setup.kernels);
}

void tell_tool_spec(FieldSink& sink, const ToolSpec& tool)
{
    sink.text("core", kCoreNames.at(tool.core.index()));
    sink.number("radius_m", tool.radius_m);
    sink.number("stiffness_n_per_m", tool.stiffness_n_per_m);
    sink.number("angular_stiffness_nm_per_rad", tool.angular_stiffness_nm_per_rad);
    sink.number("shading_m", tool.shading_m);
    sink.number("force_max_n", tool.force_max_n);
    sink.number("torque_max_nm", tool.torque_max_nm);
    sink.number("speed_max_m_per_s", tool.speed_max_m_per_s);
    sink.flag("wants_contacts", tool.wants_contacts);
    sink.flag("wants_pairs", tool.wants_pairs);
    sink.flag("query_only", tool.query_only);
    sink.flag("wants_distance", tool.wants_distance);
}

void tell_object(FieldSink& sink, const RecordedSetup& setup, std::size_t number)
{
    const ObjectSpec& object = setup.objects[number];
    const auto which = static_cast<std::uint32_t>(number);
    sink.text("name", setup.name_of({RecordedName::Kind::object, which}));
    sink.integer("model", object.model.value);
    tell_pose(sink, setup.poses[number]);
    tell_material(sink, object.material);
}

void tell_model_spec(FieldSink& sink, const RecordedSetup& setup, std::size_t number)
{
    const RecordedModel& model = setup.models[number];
    const auto which = static_cast<std::uint32_t>(number);
    sink.text("name", setup.name_of({RecordedName::Kind::model, which}));
    sink.integer("pages", model.capacities.pages);
    sink.integer("index_pages", model.capacities.index_pages);
    sink.integer("faces", model.capacities.faces);
    sink.integer("blocks", model.capacities.blocks);
    sink.integer("nodes", model.capacities.nodes);
    sink.flag("is_streamed_model", model.base.empty());
}

void tell_frame(FieldSink& sink, const ReplayedFrameView& frame)
{
    sink.integer("frame", static_cast<std::int64_t>(frame.number));
    sink.integer("time_ns", frame.given.now_ns);
    sink.number("time_s", static_cast<double>(frame.given.now_ns - frame.first_time_ns) * 1e-9);
    sink.words("faults", names_of(frame.returned.faults));
    tell_work(sink, frame.returned.work);
    tell_budgets(sink, frame.given.budgets);
    sink.integer("arrivals", count_of(frame.given.events, QueueEventKind::arrival));
    sink.integer("link_updates", count_of(frame.given.events, QueueEventKind::link_update));
    sink.integer("request_room", frame.given.request_room);
    const SceneOutput& scene = frame.returned.scene;
    sink.integer("objects", scene.objects);
    sink.integer("pairs_awake", scene.pairs);
    sink.integer("tools_over_capacity", scene.tools_over_capacity);
    sink.integer("walled_tools", scene.walled_tools);
    sink.integer("traversals", scene.walks);
    for (std::size_t i = 0; i < kChangeRefusals; ++i)
    {
        const std::string name = std::string("refused_") + kChangeRefusalNames[i];
        sink.integer(name.c_str(), scene.refused[i]);
    }
}

void tell_tool(FieldSink& sink, const ReplayedFrameView& frame, std::size_t tool)
{
    const ToolOutput& output = frame.returned.tools[tool];
    tell_device(sink, frame.given.tools[tool], frame.given.devices[tool]);
    sink.vector("force_world_n", output.force_n);
    sink.vector("torque_world_nm", output.torque_nm);
    sink.vector("proxy_world_m", output.proxy_m);
    sink.rotation("proxy_rotation_world", quaternion(output.proxy_rotation));
    sink.number("stiffness_n_per_m", output.stiffness_n_per_m);
    sink.number("lag_m", output.lag_m);
    sink.number("clear_m", output.clear_m);
    sink.number("object_way_m", output.object_way_m);
    sink.number("object_rotation_rad", output.object_rotation_rad);
    sink.vector("carried_world_m", output.carried_m);
    sink.vector("carried_world_rad", output.carried_rad);
    sink.flag("in_contact", output.in_contact);
    sink.flag("halted", output.halted);
    sink.flag("over_constrained", output.over_constrained);
    sink.flag("data_limited", output.data_limited);
    sink.flag("under_way", output.under_way);
    sink.flag("capacity_exceeded", output.capacity_exceeded);
    sink.flag("lost_object", output.lost_object);
    sink.flag("is_gone", output.is_gone);
    sink.words("faults", names_of(frame_faults(output)));
}

void tell_pair(FieldSink& sink, const PairOutput& pair)
{
    const bool has_nearest = !pair.nearest_face.is_none();
    sink.integer("tool", pair.tool);
    sink.integer("object", pair.object);
    sink.text("answer", name_of(kAnswerNames, pair.kind));
    sink.number("lower_m", pair.lower_m);
    sink.number("upper_m", pair.upper_m);
    sink.number("certified_radius_m", pair.certified_radius_m);
    sink.number("tolerated_m", pair.tolerated_m);
    sink.vector("tool_world_m", pair.tool_m);
    sink.rotation("tool_rotation_world", quaternion(pair.tool_rotation));
    sink.vector("point_world_m", pair.point_m);
    sink.integer("nearest_face", known(pair.nearest_face));
    sink.vector("nearest_point_world_m", where(has_nearest, pair.nearest_point_m));
    sink.text("nearest_feature", has_nearest ? name_of(kFeatureNames, pair.nearest_feature) : "");
    sink.number("damping_n_s_per_m", pair.damping_n_s_per_m);
    sink.flag("skipped", pair.skipped);
    sink.flag("is_shed", pair.is_shed);
    sink.flag("is_joined", pair.is_joined);
    const ContactReport* touch = pair.contacts;
    const bool has_normal = touch != nullptr && touch->normal != Vec3(0.0, 0.0, 0.0);
    sink.integer("contacts", touch == nullptr
                                 ? std::nullopt
                                 : std::optional<std::int64_t>(touch->contacts.size()));
    sink.vector("normal_world", has_normal ? std::optional<Vec3>(touch->normal) : std::nullopt);
    sink.text("side", touch == nullptr ? "" : name_of(kSideNames, touch->side));
    sink.text("intersection",
              pair.mesh == nullptr ? "" : name_of(kIntersectionNames, pair.mesh->intersection));
    sink.integer("meeting_faces", pair.mesh == nullptr
                                      ? std::nullopt
                                      : std::optional<std::int64_t>(pair.mesh->meeting.size()));
}

void tell_model(FieldSink& sink, const ModelOutput& model)
{
    sink.text("stage", name_of(kModelStageNames, model.stage));
    sink.flag("is_static", model.is_static);
    sink.integer("refined_records", model.refined_records);
    sink.integer("pages_used", model.pages.used);
    sink.integer("index_pages_used", model.index_pages.used);
    sink.integer("faces_used", model.faces.used);
    sink.integer("blocks_used", model.blocks.used);
    sink.integer("nodes_used", model.nodes.used);
}

void tell_change(FieldSink& sink, const SceneChange& change)
{
    sink.text("change", name_of(kChangeNames, change.kind));
    sink.integer("number", change.number);
    sink.integer("generation", change.generation);
    sink.integer("model", where(change.kind == SceneChangeKind::object_comes,
                                static_cast<std::int64_t>(change.object.model.value)));
    tell_pose(sink, where(has_pose(change.kind), change.pose));
    tell_material(sink, where(has_material(change.kind), change.object.material));
}

} // namespace tactus
