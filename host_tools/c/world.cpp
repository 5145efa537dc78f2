// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/world/world.hpp"

#include "host_tools/c/calls.hpp"
#include "host_tools/c/tactus.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

using namespace tactus;
using namespace tactus::c_calls;

struct tactus_world
{
    explicit tactus_world(WorldOptions options) : world(std::move(options)) {}

    World world;
    std::uint32_t serial{next_serial.fetch_add(1)}; ///< In the upper half of its handles.
    mutable std::mutex mutex;                       ///< Guards the vectors.
    std::vector<WorldObject> objects;
    std::vector<Hand> hands;

private:
    static inline std::atomic<std::uint32_t> next_serial{1};
};

namespace
{

constexpr std::uint64_t kHandBit = std::uint64_t{1} << 31U; ///< Set in handles of hands.
static_assert(kHandContacts == TACTUS_HAND_CONTACTS);
static_assert(static_cast<int>(Withheld::nothing) == 0);

tactus_handle handle_of(const tactus_world& world, std::size_t index, bool is_hand)
{
    return (std::uint64_t{world.serial} << 32U) | (is_hand ? kHandBit : 0U) | (index + 1);
}

/// Part of the world for a handle; refuses those of other worlds and kinds.
template <typename Part>
Part part_of(const tactus_world& world, const std::vector<Part>& parts, tactus_handle handle,
             bool is_hand)
{
    const std::lock_guard lock(world.mutex);
    const std::uint64_t index = handle & 0x7FFF'FFFFU;
    const bool is_ours = handle >> 32U == world.serial && ((handle & kHandBit) != 0U) == is_hand &&
                         index >= 1 && index <= parts.size();
    if (!is_ours)
    {
        refuse(TACTUS_BAD_ARGUMENT, "{}: no handle of this world", is_hand ? "hand" : "object");
    }
    return parts[index - 1];
}

/// Refuses with the text of a refused call.
template <typename Value>
void check_done(const Result<Value, Refusal>& result)
{
    if (!result)
    {
        refuse(result.error().is_usage ? TACTUS_BAD_ARGUMENT : TACTUS_REFUSED, "{}",
               result.error().text);
    }
}

WorldOptions options_of(const tactus_world_options& from)
{
    check_size(from, "options");
    check_abi(from.abi);
    WorldOptions options;
    options.rate_hz = from.rate_hz;
    options.memory_mib = from.memory_mib;
    options.stiffness_n_per_m = from.stiffness_n_per_m;
    options.object_speed_m_per_s = from.object_speed_m_per_s;
    options.objects_max = from.objects_max;
    options.wait_s = from.wait_s;
    options.duration_s = from.duration_s != 0.0 ? std::optional(from.duration_s) : std::nullopt;
    options.domain = from.domain;
    options.is_watched = from.is_watched != 0;
    options.follows_poses = from.follows_poses != 0;
    options.loads_whole = from.loads_whole != 0;
    options.allow_no_rt = from.allow_no_rt != 0;
    options.has_no_guardian = from.has_no_guardian != 0;
    options.record = from.record != nullptr ? from.record : "";
    return options;
}

Pose placed_at(const tactus_pose& from)
{
    const ObjectPose checked = pose_of(from, "pose.");
    Pose pose;
    pose.rotation = to_quaternion(checked.rotation);
    std::copy_n(from.translation_m, 3, pose.translation_m.begin());
    pose.scale = from.scale;
    return pose;
}

MaterialOptions felt_as(const tactus_material& from)
{
    const Material material = c_calls::material_of(from);
    MaterialOptions options;
    options.stiffness_n_per_m =
        from.stiffness_n_per_m != 0.0 ? std::optional(material.stiffness_n_per_m) : std::nullopt;
    options.static_friction = material.static_friction;
    options.dynamic_friction = material.dynamic_friction;
    options.damping_n_s_per_m = material.damping_n_s_per_m;
    options.viscosity_n_s_per_m = material.viscosity_n_s_per_m;
    options.texture_height_m = material.texture_height_m;
    options.texture_length_m = material.texture_length_m;
    return options;
}

WorldModel model_of(const tactus_world_object& from)
{
    check_range(from.source, TACTUS_MODEL_FILE, TACTUS_MESH, "object.source");
    const std::string text = &given(from.text, "object.text");
    const std::string unit = &given(from.unit, "object.unit");
    switch (from.source)
    {
    case TACTUS_MODEL_FILE:
        return model_file(text);
    case TACTUS_MESH_FILE:
        return mesh_file(text, {.unit = unit});
    case TACTUS_PUBLISHED:
        return published(text);
    default:
        break;
    }
    const double* const vertices = &given(from.vertices, "object.vertices");
    const std::uint32_t* const faces = &given(from.faces, "object.faces");
    std::vector<std::array<double, 3>> positions(from.vertex_count);
    std::vector<std::array<std::uint32_t, 3>> corners(from.face_count);
    for (std::size_t i = 0; i < positions.size(); ++i)
    {
        std::copy_n(vertices + 3 * i, 3, positions[i].begin());
    }
    for (std::size_t i = 0; i < corners.size(); ++i)
    {
        std::copy_n(faces + 3 * i, 3, corners[i].begin());
    }
    return mesh(std::move(positions), std::move(corners), {.unit = unit, .name = text});
}

HandPose hand_pose(const double* position_m, const double* rotation)
{
    HandPose pose;
    const double* const place = &given(position_m, "position_m");
    std::copy_n(place, 3, pose.position_m.begin());
    if (rotation != nullptr)
    {
        check_finite(rotation, 9, "rotation");
        const Mat3 turned = c_calls::to_rotation(rotation);
        if (!is_rotation(turned, kRotationTolerance))
        {
            refuse(TACTUS_BAD_ARGUMENT, "rotation: not a rotation within {}", kRotationTolerance);
        }
        pose.rotation = to_quaternion(orthonormalised(turned));
    }
    return pose;
}

void write_state(const Hand& hand, const HandState& from, tactus_hand_state& to)
{
    check_size(to, "state");
    to = {};
    to.size = sizeof(to);
    to.frame = from.frame;
    std::ranges::copy(from.force_n, to.force_n);
    std::ranges::copy(from.torque_nm, to.torque_nm);
    std::ranges::copy(from.position_m, to.position_m);
    std::ranges::copy(from.proxy_m, to.proxy_m);
    const Mat3 turned = tactus::to_rotation(from.proxy_rotation);
    for (int i = 0; i < 9; ++i)
    {
        to.proxy_rotation[i] = turned(i / 3, i % 3);
    }
    to.in_contact = from.in_contact ? 1 : 0;
    to.began_inside = from.began_inside ? 1 : 0;
    to.withheld = static_cast<std::int32_t>(from.withheld);
    to.causes = static_cast<std::uint32_t>(from.causes);
    to.buttons = from.buttons;
    to.contact_count = from.contact_count;
    for (std::size_t i = 0; i < from.contact_count; ++i)
    {
        const HandContact& contact = from.contacts[i];
        tactus_hand_contact& written = to.contacts[i];
        written.object = contact.object;
        written.kind = static_cast<std::int32_t>(contact.kind);
        written.is_touched = contact.is_touched ? 1 : 0;
        written.lower_m = contact.lower_m;
        written.upper_m = contact.upper_m;
        std::ranges::copy(contact.on_tool_m, written.on_tool_m);
        std::ranges::copy(contact.on_object_m, written.on_object_m);
    }
    const std::string why = hand.why(from);
    std::copy_n(why.data(), std::min(why.size(), sizeof(to.why) - 1), to.why);
}

std::array<double, 3> three_of(const double* numbers, const char* name)
{
    check_finite(&given(numbers, name), 3, name);
    return {numbers[0], numbers[1], numbers[2]};
}

/// Edit of an object by what a tool sweeps.
using SweptEdit = Result<double, Refusal> (WorldObject::*)(const WorldTool&, const HandPose&,
                                                           const std::array<double, 3>&) const;

tactus_result edit_by_sweep(SweptEdit edit, tactus_world* world, tactus_handle object,
                            const char* tool, const double* position_m, const double* rotation,
                            const double* to_m, double* volume_m3, tactus_error* error)
{
    return guarded(error,
                   [&]
                   {
                       const tactus_world& in = given(world, "world");
                       const WorldObject edited = part_of(in, in.objects, object, false);
                       const auto changed =
                           (edited.*edit)(tactus::tool(&given(tool, "tool")),
                                          hand_pose(position_m, rotation), three_of(to_m, "to_m"));
                       check_done(changed);
                       c_calls::write(volume_m3, 0, changed.value());
                   });
}

} // namespace

extern "C"
{

    void tactus_world_options_default(tactus_world_options* options)
    {
        if (options != nullptr)
        {
            const WorldOptions defaults;
            *options = {};
            options->size = sizeof(*options);
            options->abi = TACTUS_ABI;
            options->rate_hz = defaults.rate_hz;
            options->memory_mib = defaults.memory_mib;
            options->stiffness_n_per_m = defaults.stiffness_n_per_m;
            options->object_speed_m_per_s = defaults.object_speed_m_per_s;
            options->wait_s = defaults.wait_s;
            options->follows_poses = defaults.follows_poses ? 1 : 0;
            options->loads_whole = defaults.loads_whole ? 1 : 0;
        }
    }

    void tactus_world_object_default(tactus_world_object* object)
    {
        if (object != nullptr)
        {
            *object = {};
            object->size = sizeof(*object);
            object->unit = "m";
            object->pose.scale = 1.0;
            object->pose.rotation[0] = object->pose.rotation[4] = object->pose.rotation[8] = 1.0;
        }
    }

    tactus_result tactus_world_make(const tactus_world_options* options, tactus_world** world,
                                    tactus_error* error)
    {
        return guarded(error,
                       [&]
                       {
                           tactus_world*& result = given(world, "world");
                           result = new tactus_world(options_of(given(options, "options")));
                       });
    }

    void tactus_world_end(tactus_world* world)
    {
        delete world;
    }

    tactus_result tactus_world_add(tactus_world* world, const tactus_world_object* object,
                                   tactus_handle* handle, tactus_error* error)
    {
        return guarded(error,
                       [&]
                       {
                           tactus_world& in = given(world, "world");
                           const tactus_world_object& from = given(object, "object");
                           check_size(from, "object");
                           tactus_handle& result = given(handle, "handle");
                           ObjectOptions options;
                           options.pose = placed_at(from.pose);
                           check_range(from.edit_faces, 0, kMaxAddedFaces, "object.edit_faces");
                           options.edit_faces = from.edit_faces;
                           if (from.material != nullptr)
                           {
                               options.material = felt_as(*from.material);
                           }
                           const WorldObject added = in.world.add(model_of(from), options);
                           if (!added)
                           {
                               refuse(TACTUS_REFUSED, "{}", added.error());
                           }
                           const std::lock_guard lock(in.mutex);
                           in.objects.push_back(added);
                           result = handle_of(in, in.objects.size() - 1, false);
                       });
    }

    tactus_result tactus_world_add_hand(tactus_world* world, const char* tool, const char* device,
                                        const char* edit, tactus_handle* hand, tactus_error* error)
    {
        return guarded(error,
                       [&]
                       {
                           tactus_world& in = given(world, "world");
                           tactus_handle& result = given(hand, "hand");
                           const Hand added =
                               in.world.add(tactus::tool(&given(tool, "tool")),
                                            device != nullptr ? tactus::device(std::string(device))
                                                              : by_program(),
                                            {.edit = edit != nullptr ? edit : ""});
                           if (!added)
                           {
                               refuse(TACTUS_REFUSED, "{}", added.error());
                           }
                           const std::lock_guard lock(in.mutex);
                           in.hands.push_back(added);
                           result = handle_of(in, in.hands.size() - 1, true);
                       });
    }

    tactus_result tactus_world_start(tactus_world* world, tactus_error* error)
    {
        return guarded(error, [&] { check_done(given(world, "world").world.start()); });
    }

    tactus_result tactus_world_stop(tactus_world* world, tactus_error* error)
    {
        return guarded(error, [&] { check_done(given(world, "world").world.stop()); });
    }

    tactus_result tactus_world_state(const tactus_world* world, tactus_handle hand,
                                     tactus_hand_state* state, tactus_error* error)
    {
        return guarded(error,
                       [&]
                       {
                           const tactus_world& in = given(world, "world");
                           const Hand felt = part_of(in, in.hands, hand, true);
                           write_state(felt, felt.state(), given(state, "state"));
                       });
    }

    tactus_result tactus_world_hold(tactus_world* world, tactus_handle hand,
                                    const double* position_m, const double* rotation,
                                    tactus_error* error)
    {
        return guarded(
            error,
            [&]
            {
                const tactus_world& in = given(world, "world");
                check_done(part_of(in, in.hands, hand, true).hold(hand_pose(position_m, rotation)));
            });
    }

    tactus_result tactus_world_step(tactus_world* world, tactus_handle hand,
                                    const double* position_m, const double* rotation, double dt_s,
                                    tactus_hand_state* state, tactus_error* error)
    {
        return guarded(error,
                       [&]
                       {
                           tactus_world& in = given(world, "world");
                           if (hand == 0)
                           {
                               check_done(in.world.step(dt_s));
                               return;
                           }
                           const Hand felt = part_of(in, in.hands, hand, true);
                           if (state != nullptr)
                           {
                               check_size(*state, "state");
                           }
                           const auto stepped = felt.step(hand_pose(position_m, rotation), dt_s);
                           check_done(stepped);
                           if (state != nullptr)
                           {
                               write_state(felt, stepped.value(), *state);
                           }
                       });
    }

    tactus_result tactus_world_move(tactus_world* world, tactus_handle object,
                                    const tactus_pose* pose, tactus_error* error)
    {
        return guarded(
            error,
            [&]
            {
                const tactus_world& in = given(world, "world");
                check_done(
                    part_of(in, in.objects, object, false).move(placed_at(given(pose, "pose"))));
            });
    }

    tactus_result tactus_world_feel(tactus_world* world, tactus_handle object,
                                    const tactus_material* material, tactus_error* error)
    {
        return guarded(error,
                       [&]
                       {
                           const tactus_world& in = given(world, "world");
                           check_done(part_of(in, in.objects, object, false)
                                          .feel(felt_as(given(material, "material"))));
                       });
    }

    tactus_result tactus_world_remove(tactus_world* world, tactus_handle object,
                                      tactus_error* error)
    {
        return guarded(error,
                       [&]
                       {
                           const tactus_world& in = given(world, "world");
                           check_done(part_of(in, in.objects, object, false).remove());
                       });
    }

    tactus_result tactus_world_carve(tactus_world* world, tactus_handle object, const char* tool,
                                     const double* position_m, const double* rotation,
                                     const double* to_m, double* volume_m3, tactus_error* error)
    {
        return edit_by_sweep(&WorldObject::carve, world, object, tool, position_m, rotation, to_m,
                             volume_m3, error);
    }

    tactus_result tactus_world_fill(tactus_world* world, tactus_handle object, const char* tool,
                                    const double* position_m, const double* rotation,
                                    const double* to_m, double* volume_m3, tactus_error* error)
    {
        return edit_by_sweep(&WorldObject::fill, world, object, tool, position_m, rotation, to_m,
                             volume_m3, error);
    }

    tactus_result tactus_world_displace(tactus_world* world, tactus_handle object,
                                        const double* center_m, double radius_m,
                                        const double* vector_m, double* volume_m3,
                                        tactus_error* error)
    {
        return guarded(error,
                       [&]
                       {
                           const tactus_world& in = given(world, "world");
                           const WorldObject edited = part_of(in, in.objects, object, false);
                           check_finite(&radius_m, 1, "radius_m");
                           const auto changed =
                               edited.displace(three_of(center_m, "center_m"), radius_m,
                                               three_of(vector_m, "vector_m"));
                           check_done(changed);
                           c_calls::write(volume_m3, 0, changed.value());
                       });
    }

    tactus_result tactus_world_save(const tactus_world* world, tactus_handle object,
                                    const char* path, tactus_error* error)
    {
        return guarded(error,
                       [&]
                       {
                           const tactus_world& in = given(world, "world");
                           check_done(
                               part_of(in, in.objects, object, false).save(&given(path, "path")));
                       });
    }

    tactus_result tactus_world_counts_of(const tactus_world* world, tactus_world_counts* counts,
                                         tactus_error* error)
    {
        return guarded(error,
                       [&]
                       {
                           const tactus_world& in = given(world, "world");
                           check_size(given(counts, "counts"), "counts");
                           const WorldCounts now = in.world.counts();
                           *counts = {};
                           counts->size = sizeof(*counts);
                           counts->frames = now.frames;
                           counts->missed = now.missed;
                           counts->overruns = now.overruns;
                           counts->latency_misses = now.latency_misses;
                           counts->brakes = now.brakes;
                           counts->is_running = in.world.is_running() ? 1 : 0;
                       });
    }

} // extern "C"
