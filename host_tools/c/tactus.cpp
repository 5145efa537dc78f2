// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/c/tactus.h"

#include "host_tools/c/calls.hpp"
#include "rt_core/frame/frame.hpp"
#include "rt_core/frame/list_touches.hpp"
#include "rt_core/geometry/object_speed_limit.hpp"
#include "rt_core/math/rotation.hpp"
#include "rt_core/records/object_touch.hpp"
#include "transport/base/refusal.hpp"
#include "transport/chunk_loader.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/inside_test.hpp"
#include "transport/material_text.hpp"
#include "transport/model_name.hpp"
#include "transport/pool_plan.hpp"
#include "transport/store/static_model.hpp"
#include "transport/store/store_link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

using namespace tactus;
using namespace tactus::c_calls;

struct tactus_model
{
    std::unique_ptr<dds::DdsClient> client; ///< First member, since it must outlive `served`.
    ServedModel served;
    std::optional<ModelHeader> header; ///< View of `served`.
    bool is_taken{false}; ///< True while a frame uses the model; protected by `registry_mutex`.
};

struct tactus_static_model
{
    std::unique_ptr<StaticModel> model;
};

struct tactus_frame
{
    explicit tactus_frame(std::span<std::byte> lent) : memory(lent), arena(lent) {}

    std::span<std::byte> memory;
    Arena arena;
    std::vector<tactus_model*> models;
    std::optional<Frame> frame;
    std::optional<ChunkLoader> chunk_loader;
    std::vector<ToolState> states;
    /// Changes for the next frame. The change of a moving object has the target pose and stays
    /// until the object has reached it.
    StaticVector<SceneChange, kMaxSceneChanges> changes;
    std::uint32_t objects{0};
    std::vector<Similarity> places;                ///< Present places of the objects in the frame.
    ObjectTouches touches;                         ///< Touches after the last frame.
    std::array<bool, kMaxTools> is_rate_limited{}; ///< Flags by tool in the last frame.
    ObjectSpeedLimit belief;
    std::int64_t period_ns{0};
    /// Time of the frames, written by tactus_frame_run() and read by tactus_frame_load().
    std::atomic<std::int64_t> now_ns{0};
    std::uint64_t frames{0};
    FrameOutput output;
};

namespace
{

/// Mutex and list of existing frames, to detect memory or models used twice.
std::mutex registry_mutex;
std::vector<const tactus_frame*>& registry()
{
    static std::vector<const tactus_frame*> frames;
    return frames;
}

// --- Models --------------------------------------------------------------------------------------

void finish(std::unique_ptr<tactus_model>& made, Result<ServedModel, Refusal> served,
            tactus_model*& model)
{
    if (!served)
    {
        refuse(TACTUS_REFUSED, "{}", served.error().text);
    }
    made->served = std::move(served).value();
    made->header = ModelHeader::parse(made->served.header).value();
    model = made.release();
}

// --- Set-up --------------------------------------------------------------------------------------

ToolSpec tool_of(const tactus_tool& tool, std::size_t index)
{
    const std::string name = fmt::format("tools[{}].", index);
    check_size(tool, name.c_str());
    check_range(tool.shape, TACTUS_SPHERE, TACTUS_BOX, name + "shape");
    const double largest_m = tool.query_only != 0 ? 1e3 : 1.0; // No tool of a hand is larger.
    check_range(tool.radius_m, 1e-6, largest_m, name + "radius_m");
    check_range(tool.stiffness_n_per_m, kSmallestValue, kLargestValue, name + "stiffness_n_per_m");
    check_range(tool.force_max_n, kSmallestValue, kLargestValue, name + "force_max_n");
    check_range(tool.torque_max_nm, 0.0, kLargestValue, name + "torque_max_nm");
    check_range(tool.speed_max_m_per_s, kSlowest_m_per_s, kLargestValue,
                name + "speed_max_m_per_s");
    check_range(tool.shading_m, tool.shading_m == 0.0 ? 0.0 : kShadingWidthMin_m,
                kShadingWidthMax_m, name + "shading_m");
    if (tool.shading_m != 0.0 && tool.shape != TACTUS_SPHERE)
    {
        refuse(TACTUS_BAD_ARGUMENT, "{}shading_m: {:g}; only a sphere has force shading", name,
               tool.shading_m);
    }
    for (const double half_m : tool.half_m)
    {
        check_range(half_m, tool.shape == TACTUS_BOX ? 0.0 : -largest_m, largest_m,
                    name + "half_m");
    }
    ToolSpec spec;
    spec.radius_m = tool.radius_m;
    spec.stiffness_n_per_m = tool.stiffness_n_per_m;
    spec.force_max_n = tool.force_max_n;
    spec.speed_max_m_per_s = tool.speed_max_m_per_s;
    spec.torque_max_nm = tool.torque_max_nm;
    spec.query_only = tool.query_only != 0;
    spec.shading_m = tool.shading_m;
    spec.wants_distance = tool.wants_distance != 0;
    const Vec3 half_m = to_vec(tool.half_m);
    if (tool.shape == TACTUS_CAPSULE)
    {
        spec.core = Segment{-half_m, half_m};
    }
    else if (tool.shape == TACTUS_BOX)
    {
        spec.core = Box{half_m};
    }
    return spec;
}

/// Adds a change for the next frame; it replaces a pending change of the same kind and object.
/// Refuses an unknown object, and more than kMaxSceneChanges changes.
void add_change(tactus_frame& frame, const SceneChange& change)
{
    check_range(change.number, 0, frame.objects - 1, "object");
    const auto is_the_same = [&change](const SceneChange& other)
    { return other.kind == change.kind && other.number == change.number; };
    auto* const before = std::ranges::find_if(frame.changes, is_the_same);
    if (before != frame.changes.end())
    {
        *before = change;
    }
    else if (!frame.changes.try_push_back(change))
    {
        refuse(TACTUS_BUSY, "{} changes of objects are pending; run a frame first",
               frame.changes.size());
    }
}

/// The caller's set-up, converted to types of the library. The models remain the caller's.
struct Scene
{
    std::vector<ToolSpec> tools;
    std::vector<ObjectSpec> objects;
    std::vector<ObjectPose> poses;
    std::vector<ModelHeader> headers;
    std::vector<ModelSource> sources;
    FrameSetup setup;
};

void read_setup(const tactus_setup& from, Scene& scene)
{
    check_size(from, "setup");
    check_abi(from.abi);
    check_range(from.model_count, 1, kMaxModels, "setup.model_count");
    check_range(from.tool_count, 1, kMaxTools, "setup.tool_count");
    check_range(from.object_count, 1, kMaxObjects, "setup.object_count");
    check_range(static_cast<double>(from.period_ns), 1e4, 1e9, "setup.period_ns");
    check_range(from.object_speed_max_m_per_s, kSlowest_m_per_s, kLargestValue,
                "setup.object_speed_max_m_per_s");
    for (std::uint32_t i = 0; i < from.model_count; ++i)
    {
        const tactus_model& model = given(given(from.models, "setup.models") == nullptr
                                              ? static_cast<tactus_model*>(nullptr)
                                              : from.models[i],
                                          "setup.models[i]");
        scene.headers.push_back(*model.header);
    }
    for (std::uint32_t i = 0; i < from.tool_count; ++i)
    {
        scene.tools.push_back(tool_of((&given(from.tools, "setup.tools"))[i], i));
    }
    for (std::uint32_t i = 0; i < from.object_count; ++i)
    {
        const tactus_object& object = (&given(from.objects, "setup.objects"))[i];
        const std::string name = fmt::format("objects[{}].", i);
        check_size(object, name.c_str());
        check_range(object.model, 0, from.model_count - 1, name + "model");
        check_range(object.static_friction, 0.0, kRoughest, name + "static_friction");
        check_range(object.dynamic_friction, 0.0, object.static_friction,
                    name + "dynamic_friction");
        Material material;
        material.static_friction = object.static_friction;
        material.dynamic_friction = object.dynamic_friction;
        scene.objects.push_back({ModelId{object.model}, material});
        scene.poses.push_back(pose_of(object.pose, name + "pose."));
    }
    scene.setup.tools = scene.tools;
    scene.setup.objects = scene.objects;
    scene.setup.poses = scene.poses;
    scene.setup.period_ns = from.period_ns;
    scene.setup.static_when_it_fits = from.loads_whole != 0;
}

void plan_pools(const tactus_setup& from, std::size_t bytes, Scene& scene)
{
    std::vector<ModelCapacities> capacities(from.model_count);
    if (!try_plan_pools(scene.setup, scene.headers, bytes, 0, capacities))
    {
        refuse(TACTUS_REFUSED, "memory: {} bytes; the models need at least {}", bytes,
               least_pool_bytes(scene.setup, scene.headers, 0));
    }
    for (std::uint32_t i = 0; i < from.model_count; ++i)
    {
        const ServedModel& model = from.models[i]->served;
        scene.sources.push_back({model.header, model.base, capacities[i]});
    }
    scene.setup.models = scene.sources;
}

/// Registers a frame; refuses memory or a model that another frame uses.
void enter(tactus_frame& frame)
{
    const std::lock_guard lock(registry_mutex);
    const std::byte* begin = frame.memory.data();
    const std::byte* end = begin + frame.memory.size();
    for (const tactus_frame* other : registry())
    {
        const std::byte* others = other->memory.data();
        if (std::less<>{}(begin, others + other->memory.size()) && std::less<>{}(others, end))
        {
            refuse(TACTUS_BUSY, "memory: another frame uses this memory; end that frame first");
        }
    }
    for (const tactus_model* model : frame.models)
    {
        if (model->is_taken || std::ranges::count(frame.models, model) > 1)
        {
            refuse(TACTUS_BUSY,
                   "models: '{}' is in another frame, or twice in this one; open the model once "
                   "for each use",
                   model->served.name);
        }
    }
    registry().push_back(&frame);
    for (tactus_model* model : frame.models)
    {
        model->is_taken = true;
    }
}

void leave(tactus_frame& frame) noexcept
{
    const std::lock_guard lock(registry_mutex);
    std::erase(registry(), &frame);
    for (tactus_model* model : frame.models)
    {
        model->is_taken = false;
    }
}

void start(tactus_frame& frame, const FrameSetup& setup)
{
    if (const auto started = Frame::start(frame.frame, frame.arena, setup); !started)
    {
        refuse(TACTUS_REFUSED, "{}", refusal_text(started.error()));
    }
    ModelPools& pools = frame.frame->pools();
    frame.chunk_loader.emplace(frame.arena, pools.slots, pools.cache.queues, Log{});
    for (std::uint32_t i = 0; i < frame.models.size(); ++i)
    {
        Model& model = frame.frame->model({i});
        ServedModel& served = frame.models[i]->served;
        frame.chunk_loader->add(model.header, model.linker, *served.link, served.name);
    }
    frame.states.resize(setup.tools.size());
    frame.objects = static_cast<std::uint32_t>(setup.objects.size());
    frame.period_ns = setup.period_ns;
    frame.places.assign(setup.poses.begin(), setup.poses.end());
}

// --- Frames --------------------------------------------------------------------------------------

void load(tactus_frame& frame)
{
    frame.chunk_loader->step(frame.now_ns.load(std::memory_order_relaxed));
}

/// Moves an object in this frame, rate-limited near tools. False if the move must continue in the
/// next frame.
bool carry(tactus_frame& frame, SceneChange& move)
{
    const double since_s = 1e-9 * static_cast<double>(frame.period_ns);
    Similarity& place = frame.places[move.number];
    const auto way_to_m = [&](const Similarity& to)
    { return way_at_touches_m(frame.touches.view(), move.number, place, to); };
    const double way_m = way_to_m(move.pose);
    for (const ObjectTouch& touch : frame.touches)
    {
        frame.is_rate_limited[touch.tool] |= touch.object == move.number && touch.is_in_reach &&
                                             frame.belief.exceeds_limit(way_m, since_s);
    }
    const bool is_held = frame.belief.is_too_fast(way_m, since_s);
    if (is_held)
    {
        static_cast<Similarity&>(move.pose) =
            frame.belief.held(place, move.pose, since_s, way_to_m);
    }
    place = move.pose;
    return !is_held;
}

/// Removes and returns the pending changes for this frame. Moves that need further frames stay
/// pending.
StaticVector<SceneChange, kMaxSceneChanges> take_changes(tactus_frame& frame)
{
    StaticVector<SceneChange, kMaxSceneChanges> changes = frame.changes;
    frame.changes.clear();
    frame.is_rate_limited.fill(false);
    for (SceneChange& change : changes)
    {
        const SceneChange whole = change;
        if (change.kind == SceneChangeKind::object_moves && !carry(frame, change))
        {
            frame.changes.push_back(whole);
        }
    }
    return changes;
}

void run_one(tactus_frame& frame)
{
    const std::int64_t now_ns = frame.now_ns.load(std::memory_order_relaxed) + frame.period_ns;
    frame.now_ns.store(now_ns, std::memory_order_relaxed);
    const auto changes = take_changes(frame);
    frame.output = frame.frame->run(
        {.tools = frame.states, .changes = changes.view(), .budgets = {}, .now_ns = now_ns});
    // The next frame's take_changes() reads the touches.
    list_touches(*frame.frame, frame.output.pairs, frame.belief, frame.touches);
    ++frame.frames;
}

bool is_settled(const tactus_frame& frame)
{
    const FrameOutput& output = frame.output;
    const bool is_any_on_its_way =
        std::ranges::any_of(frame.changes, [](const SceneChange& change)
                            { return change.kind == SceneChangeKind::object_moves; });
    return !is_any_on_its_way &&
           std::ranges::all_of(output.pairs,
                               [&frame](const PairOutput& pair)
                               {
                                   return is_known(pair.kind) ||
                                          (pair.kind == AnswerKind::separated &&
                                           !frame.frame->tool(pair.tool).spec().wants_distance);
                               }) &&
           std::ranges::none_of(output.tools, [](const ToolOutput& tool)
                                { return tool.halted || tool.data_limited || tool.under_way; });
}

void find_insides(const tactus_frame& frame, const double* positions_m, std::uint8_t* inside)
{
    const std::size_t tools = frame.states.size();
    check_positions(positions_m, tools, "positions_m");
    std::fill(inside, inside + tools, std::uint8_t{0});
    for (std::uint32_t object = 0; object < frame.objects; ++object)
    {
        const ModelId model = frame.frame->objects()[object].spec.model;
        const ServedModel& served = frame.models[model.value]->served;
        const ModelHeader header = ModelHeader::parse(served.header).value();
        const InsideTest test(header, served.base);
        for (std::uint32_t tool = 0; tool < tools; ++tool)
        {
            const Vec3 source_m =
                frame.places[object].world_to_local(to_vec(positions_m + 3 * tool));
            const bool is_held = !frame.frame->tool(tool).spec().query_only &&
                                 test.holds(source_m - header.origin_m());
            inside[tool] = is_held ? 1 : inside[tool];
        }
    }
}

void place_tools(tactus_frame& frame, const tactus_poses& poses, std::size_t pose)
{
    for (std::size_t tool = 0; tool < frame.states.size(); ++tool)
    {
        const std::size_t index = pose * frame.states.size() + tool;
        frame.states[tool].position_m = to_vec(poses.positions_m + 3 * index);
        frame.states[tool].rotation = poses.rotations == nullptr
                                          ? Mat3(Mat3::Identity())
                                          : to_rotation(poses.rotations + 9 * index);
    }
}

std::uint32_t flags_of(const ToolOutput& tool, bool is_rate_limited)
{
    return (is_rate_limited ? TACTUS_RATE_LIMITED : 0U) |
           (tool.in_contact ? TACTUS_IN_CONTACT : 0U) | (tool.halted ? TACTUS_HALTED : 0U) |
           (tool.over_constrained ? TACTUS_OVER_CONSTRAINED : 0U) |
           (tool.capacity_exceeded ? TACTUS_CAPACITY_EXCEEDED : 0U) |
           (tool.data_limited ? TACTUS_DATA_LIMITED : 0U);
}

void write_answers(const tactus_frame& frame, const tactus_poses& poses, std::size_t pose)
{
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    const FrameOutput& output = frame.output;
    const std::size_t first = pose * output.tools.size();
    for (std::size_t t = 0; t < output.tools.size(); ++t)
    {
        const ToolOutput& tool = output.tools[t];
        write(poses.force_n, first + t, tool.force_n);
        write(poses.torque_nm, first + t, tool.torque_nm);
        write(poses.proxy_m, first + t, tool.proxy_m);
        write(poses.flags, first + t, flags_of(tool, frame.is_rate_limited[t]));
        // An object without a pair is proven clear of the tool.
        for (std::size_t k = 0; k < frame.objects; ++k)
        {
            const std::size_t index = (first + t) * frame.objects + k;
            write(poses.lower_m, index, tool.clear_m);
            write(poses.upper_m, index, kInfinity);
            write(poses.kind, index, static_cast<std::uint8_t>(TACTUS_SEPARATED));
            write(poses.nearest_m, index, Vec3(kUnknown, kUnknown, kUnknown));
        }
    }
    for (const PairOutput& pair : output.pairs)
    {
        const std::size_t index = (first + pair.tool) * frame.objects + pair.object;
        write(poses.lower_m, index, pair.lower_m);
        write(poses.upper_m, index, pair.upper_m);
        write(poses.kind, index, static_cast<std::uint8_t>(pair.kind));
        if (is_known(pair.kind))
        {
            write(poses.nearest_m, index, pair.nearest_point_m);
        }
    }
}
static_assert(static_cast<int>(AnswerKind::exact) == TACTUS_EXACT);
static_assert(static_cast<int>(AnswerKind::separated) == TACTUS_SEPARATED);
static_assert(static_cast<int>(AnswerKind::bounded) == TACTUS_BOUNDED);
static_assert(static_cast<int>(AnswerKind::stale) == TACTUS_STALE);
static_assert(static_cast<int>(AnswerKind::within_tolerance) == TACTUS_WITHIN_TOLERANCE);
static_assert(static_cast<int>(Side::unsigned_distance) == TACTUS_UNSIGNED);
static_assert(static_cast<int>(Side::outside) == TACTUS_OUTSIDE);
static_assert(static_cast<int>(Side::inside) == TACTUS_INSIDE);

void check_poses(const tactus_frame& frame, const tactus_poses& poses)
{
    check_size(poses, "poses");
    check_range(poses.rounds, 0, 10'000, "poses.rounds");
    const std::size_t places = poses.count * frame.states.size();
    check_positions(&given(poses.positions_m, "poses.positions_m"), places, "poses.positions_m");
    if (poses.rotations == nullptr)
    {
        return;
    }
    check_finite(poses.rotations, 9 * places, "poses.rotations");
    for (std::size_t i = 0; i < places; ++i)
    {
        if (!is_rotation(to_rotation(poses.rotations + 9 * i), kRotationTolerance))
        {
            refuse(TACTUS_BAD_ARGUMENT, "poses.rotations: matrix {} is not a rotation within {}", i,
                   kRotationTolerance);
        }
    }
}

} // namespace

extern "C"
{

    uint32_t tactus_abi(void)
    {
        return TACTUS_ABI;
    }

    const char* tactus_version(void)
    {
        return TACTUS_VERSION;
    }

    tactus_result tactus_model_open(uint32_t abi, const char* path, tactus_model** model,
                                    tactus_error* error)
    {
        return guarded(error,
                       [&]
                       {
                           check_abi(abi);
                           tactus_model*& result = given(model, "model");
                           const std::string file = &given(path, "path");
                           auto made = std::make_unique<tactus_model>();
                           finish(made, serve_from_file(file, "model", {}), result);
                           result->served.name = file;
                       });
    }

    tactus_result tactus_model_find(uint32_t abi, const char* name, uint32_t domain, double wait_s,
                                    tactus_model** model, tactus_error* error)
    {
        return guarded(error,
                       [&]
                       {
                           check_abi(abi);
                           tactus_model*& result = given(model, "model");
                           check_range(domain, 0, 232, "domain");
                           check_range(wait_s, 0.0, 3600.0, "wait_s");
                           const auto selector = parse_selector(&given(name, "name"));
                           if (!selector)
                           {
                               refuse(TACTUS_BAD_ARGUMENT, "{}", selector.error().text);
                           }
                           auto client = dds::DdsClient::create(domain, "library", {});
                           if (!client)
                           {
                               refuse(TACTUS_REFUSED, "{}", client.error().text);
                           }
                           auto made = std::make_unique<tactus_model>();
                           made->client = std::move(client).value();
                           const std::chrono::milliseconds wait{
                               static_cast<std::int64_t>(1e3 * wait_s)};
                           finish(made, made->client->find(selector.value(), wait), result);
                       });
    }

    tactus_result tactus_model_info_of(const tactus_model* model, tactus_model_info* info,
                                       tactus_error* error)
    {
        return guarded(error,
                       [&]
                       {
                           const ModelHeader& header = *given(model, "model").header;
                           check_size(given(info, "info"), "info");
                           const HeaderFields& fields = header.fields();
                           for (std::size_t i = 0; i < 3; ++i)
                           {
                               info->low_m[i] = fields.origin_m[i];
                               info->high_m[i] =
                                   fields.origin_m[i] + static_cast<double>(header.quantum_m()) *
                                                            fields.extent_quanta[i];
                           }
                           info->diagonal_m = header.diagonal_m();
                           info->faces = fields.source_faces;
                           info->vertices = fields.source_vertices;
                           info->is_closed = header.is_closed() ? 1 : 0;
                           const std::string hash = hash_text(model->served.hash);
                           std::memcpy(info->hash, hash.c_str(), sizeof(info->hash));
                       });
    }

    tactus_result tactus_model_close(tactus_model* model, tactus_error* error)
    {
        return guarded(error,
                       [&]
                       {
                           if (model == nullptr)
                           {
                               return;
                           }
                           {
                               const std::lock_guard lock(registry_mutex);
                               if (model->is_taken)
                               {
                                   refuse(TACTUS_BUSY,
                                          "'{}' is in use by a frame; end the frame first",
                                          model->served.name);
                               }
                           }
                           delete model;
                       });
    }

    tactus_result tactus_static_model_open(uint32_t abi, const char* path,
                                           tactus_static_model** model, tactus_error* error)
    {
        return guarded(error,
                       [&]
                       {
                           check_abi(abi);
                           tactus_static_model*& result = given(model, "model");
                           auto opened = StaticModel::open(&given(path, "path"));
                           if (!opened)
                           {
                               refuse(TACTUS_REFUSED, "{}", opened.error().text);
                           }
                           result = new tactus_static_model{std::move(opened).value()};
                       });
    }

    tactus_result tactus_static_model_distances(const tactus_static_model* model, size_t count,
                                                const double* points_m, double* lower_m,
                                                double* upper_m, uint8_t* side, double* nearest_m,
                                                tactus_error* error)
    {
        return guarded(error,
                       [&]
                       {
                           const StaticModel& asked = *given(model, "model").model;
                           std::vector<Vec3> places_m(count);
                           for (std::size_t i = 0; i < count; ++i)
                           {
                               places_m[i] = to_vec(&given(points_m, "points_m") + 3 * i);
                           }
                           std::vector<PointDistance> answers(count);
                           if (const auto done = asked.distances(places_m, answers); !done)
                           {
                               refuse(TACTUS_BAD_ARGUMENT, "points_m: {}", done.error().text);
                           }
                           for (std::size_t i = 0; i < count; ++i)
                           {
                               write(lower_m, i, answers[i].lower_m);
                               write(upper_m, i, answers[i].upper_m);
                               write(side, i, static_cast<std::uint8_t>(answers[i].side));
                               write(nearest_m, i, answers[i].nearest_m);
                           }
                       });
    }

    void tactus_static_model_close(tactus_static_model* model)
    {
        delete model;
    }

    void tactus_tool_default(tactus_tool* tool)
    {
        if (tool != nullptr)
        {
            const ToolSpec spec;
            *tool = {};
            tool->size = sizeof(*tool);
            tool->stiffness_n_per_m = spec.stiffness_n_per_m;
            tool->force_max_n = spec.force_max_n;
            tool->torque_max_nm = spec.torque_max_nm;
            tool->speed_max_m_per_s = spec.speed_max_m_per_s;
        }
    }

    void tactus_object_default(tactus_object* object)
    {
        if (object != nullptr)
        {
            *object = {};
            object->size = sizeof(*object);
            object->pose.scale = 1.0;
            object->pose.rotation[0] = object->pose.rotation[4] = object->pose.rotation[8] = 1.0;
        }
    }

    void tactus_material_default(tactus_material* material)
    {
        if (material != nullptr)
        {
            *material = {};
            material->size = sizeof(*material);
        }
    }

    void tactus_setup_default(tactus_setup* setup)
    {
        if (setup != nullptr)
        {
            *setup = {};
            setup->size = sizeof(*setup);
            setup->abi = TACTUS_ABI;
            setup->period_ns = FrameSetup{}.period_ns;
            setup->object_speed_max_m_per_s = 0.5;
        }
    }

    tactus_result tactus_frame_make(const tactus_setup* setup, void* memory, size_t bytes,
                                    tactus_frame** frame, tactus_error* error)
    {
        return guarded(error,
                       [&]
                       {
                           tactus_frame*& result = given(frame, "frame");
                           Scene scene;
                           read_setup(given(setup, "setup"), scene);
                           auto* first = static_cast<std::byte*>(memory);
                           given(first, "memory");
                           if (reinterpret_cast<std::uintptr_t>(first) % TACTUS_ALIGNMENT != 0)
                           {
                               refuse(TACTUS_BAD_ARGUMENT,
                                      "memory: the address is not a multiple of {} bytes",
                                      TACTUS_ALIGNMENT);
                           }
                           plan_pools(*setup, bytes, scene);
                           auto made = std::make_unique<tactus_frame>(std::span(first, bytes));
                           made->models.assign(setup->models, setup->models + setup->model_count);
                           made->belief.speed_max_m_per_s = setup->object_speed_max_m_per_s;
                           enter(*made);
                           try
                           {
                               start(*made, scene.setup);
                           }
                           catch (...)
                           {
                               leave(*made);
                               throw;
                           }
                           result = made.release();
                       });
    }

    void tactus_frame_end(tactus_frame* frame)
    {
        if (frame != nullptr)
        {
            leave(*frame);
            delete frame;
        }
    }

    tactus_result tactus_frame_load(tactus_frame* frame, tactus_error* error)
    {
        return guarded(error, [&] { load(given(frame, "frame")); });
    }

    tactus_result tactus_frame_run(tactus_frame* frame, const tactus_poses* poses,
                                   tactus_error* error)
    {
        return guarded(error,
                       [&]
                       {
                           tactus_frame& sut = given(frame, "frame");
                           check_poses(sut, given(poses, "poses"));
                           for (std::size_t pose = 0; pose < poses->count; ++pose)
                           {
                               place_tools(sut, *poses, pose);
                               run_one(sut);
                               for (std::uint32_t round = 1;
                                    round < poses->rounds && !is_settled(sut); ++round)
                               {
                                   load(sut);
                                   run_one(sut);
                               }
                               write_answers(sut, *poses, pose);
                           }
                       });
    }

    tactus_result tactus_frame_place(tactus_frame* frame, uint32_t object, const tactus_pose* pose,
                                     tactus_error* error)
    {
        return guarded(error,
                       [&]
                       {
                           tactus_frame& in = given(frame, "frame");
                           SceneChange change;
                           change.kind = SceneChangeKind::object_moves;
                           change.number = object;
                           change.pose = pose_of(given(pose, "pose"), "pose.");
                           add_change(in, change);
                       });
    }

    tactus_result tactus_frame_feel(tactus_frame* frame, uint32_t object,
                                    const tactus_material* material, tactus_error* error)
    {
        return guarded(error,
                       [&]
                       {
                           tactus_frame& in = given(frame, "frame");
                           SceneChange change;
                           change.kind = SceneChangeKind::object_feels;
                           change.number = object;
                           change.object.material = material_of(given(material, "material"));
                           add_change(in, change);
                       });
    }

    tactus_result tactus_frame_begins_inside(const tactus_frame* frame, const double* positions_m,
                                             uint8_t* inside, tactus_error* error)
    {
        return guarded(error,
                       [&]
                       {
                           find_insides(given(frame, "frame"), &given(positions_m, "positions_m"),
                                        &given(inside, "inside"));
                       });
    }

    tactus_result tactus_frame_state_of(const tactus_frame* frame, tactus_frame_state* state,
                                        tactus_error* error)
    {
        return guarded(error,
                       [&]
                       {
                           const tactus_frame& in = given(frame, "frame");
                           check_size(given(state, "state"), "state");
                           *state = {};
                           state->size = sizeof(*state);
                           state->frames = in.frames;
                           state->is_whole = in.frames > 0 ? 1 : 0;
                           for (const ModelOutput& model : in.output.models)
                           {
                               state->pages_used += model.pages.used;
                               state->pages_total += model.pages.capacity;
                               state->faces_used += model.faces.used;
                               state->is_whole = model.is_static ? state->is_whole : 0;
                           }
                       });
    }

} // extern "C"
