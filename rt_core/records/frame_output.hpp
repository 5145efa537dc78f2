// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"
#include "rt_core/records/contact.hpp"
#include "rt_core/records/door_event.hpp"
#include "rt_core/records/local_surface.hpp"
#include "rt_core/records/mesh_report.hpp"
#include "rt_core/records/scene_change.hpp"
#include "rt_core/records/work_counters.hpp"

#include <array>
#include <cstdint>
#include <span>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// What one tool got. World frame, SI.
///
/// Force and torque are those of the proxy's spring, whatever is wrong: SafeState fades them for
/// what faults_of() says.
struct ToolOutput
{
    Vec3 force_n{0.0, 0.0, 0.0};
    Vec3 proxy_m{0.0, 0.0, 0.0};           ///< Centre of the tool as the surface lets it be.
    Vec3 torque_nm{0.0, 0.0, 0.0};         ///< About the device's position. Zero for a sphere.
    Mat3 proxy_rotation{Mat3::Identity()}; ///< Of the tool's frame; a sphere's is the hand's.
    double stiffness_n_per_m{0.0}; ///< Of the spring that makes the force; 0 without contact.
    /// How far the proxy is behind: its way to the goal, along the surface where it touches; 0
    /// where it has come to rest.
    double lag_m{0.0};
    bool in_contact{false};
    bool frozen{false};   ///< The proxy waits for data, held where it is.
    bool squeezed{false}; ///< Objects leave the tool no room.
    /// The proxy went as far as the surface is known, for want of data, and would have gone
    /// farther.
    bool held_back{false};
    /// The proxy is still on its way: it came to the end of what is known, or of a frame's steps.
    bool under_way{false};
    bool cut_short{false};   ///< On its way: what it may look at in a frame was used up.
    bool crowded{false};     ///< More touches it than limits allow: force and torque may lack some.
    bool lost_object{false}; ///< In touch, and an object near it went or jumped in this frame.
    bool is_gone{false};     ///< SceneChangeKind::tool_goes: everything else is as it was made.
    /// The longest way that the frame believes any point within the tool's reach to have gone with
    /// an object since the last frame, and the largest angle by which one of them has turned. >= 0.
    double object_way_m{0.0};
    double object_turn_rad{0.0};
    /// How far, and about which rotation vector, objects took the proxy along in this frame. What
    /// the force does along that way is work of those who move the objects, and not of the wall.
    Vec3 carried_m{0.0, 0.0, 0.0};
    Vec3 carried_rad{0.0, 0.0, 0.0};
    /// Proven distance of its core from every object that no PairOutput names, at the proxy at the
    /// start of the frame; infinite where there is none.
    double clear_m{kInfinity};
    FrameFault sample_fault{FrameFault::none}; ///< What is wrong with the device (SampleWatch).

    [[nodiscard]] bool operator==(const ToolOutput&) const = default;
};

/// What a frame says of a tool with this output.
[[nodiscard]] constexpr FrameFault frame_faults(const ToolOutput& output) noexcept
{
    return output.sample_fault | (output.frozen ? FrameFault::proxy_frozen : FrameFault::none) |
           (output.squeezed ? FrameFault::proxy_squeezed : FrameFault::none) |
           (output.crowded ? FrameFault::tool_crowded : FrameFault::none) |
           (output.cut_short ? FrameFault::plane_budget_spent : FrameFault::none) |
           (output.lost_object ? FrameFault::object_lost : FrameFault::none);
}

/// Why a tool's force must fade; none while nothing is wrong. A proxy that waits for data without a
/// force has nothing to fade; one that has no room will have a force, as soon as it touches.
[[nodiscard]] constexpr FrameFault faults_of(const ToolOutput& output) noexcept
{
    const bool is_held = output.frozen && output.in_contact;
    return output.sample_fault | (output.lost_object ? FrameFault::object_lost : FrameFault::none) |
           (is_held ? FrameFault::proxy_frozen : FrameFault::none) |
           (output.squeezed ? FrameFault::proxy_squeezed : FrameFault::none);
}

/// What one pair of tool and object got. World frame, metres: the model's distances times the
/// scale.
struct PairOutput
{
    std::uint32_t tool{0};
    std::uint32_t object{0};
    AnswerKind kind{AnswerKind::bracket};
    /// Where the tool was asked about: its place at the start of the frame, or at the start of the
    /// frame's last step that had work left for this pair. Pairs of one tool may differ.
    Vec3 tool_m{0.0, 0.0, 0.0};
    Mat3 tool_rotation{Mat3::Identity()}; ///< The tool's rotation there.
    /// The point of the tool's core, there, that is nearest to the surface, or the core's centre
    /// where that is not known.
    Vec3 point_m{0.0, 0.0, 0.0};
    double lower_m{0.0}; ///< From the core, >= 0; the tool's radius is not taken off.
    double upper_m{0.0}; ///< Likewise; infinite where nothing is known yet.
    /// All original faces within it of the core are active and exact, or stood for by faces of an
    /// error of at most tolerated_m.
    double certified_radius_m{0.0};
    double tolerated_m{0.0};             ///< 0 where all faces in reach are exact.
    FaceId nearest_face{};               ///< None when there is none of the surface in reach.
    Vec3 nearest_point_m{0.0, 0.0, 0.0}; ///< On that face; without one of no meaning.
    bool skipped{false};                 ///< Answered from the last distance and the motion since.
    TriangleFeature nearest_feature{TriangleFeature::interior}; ///< Of the nearest face.
    bool is_shed{false}; ///< Nothing is loaded or refined for it: more urgent pairs had no room.
    /// False: one came round the other, and there is no force until they are proven apart.
    bool is_joined{true};
    double damping_n_s_per_m{0.0};          ///< Of the object's material, as it is felt now.
    const ContactReport* contacts{nullptr}; ///< Null unless the tool wants them.
    const MeshReport* mesh{nullptr};        ///< Null unless the tool is a mesh.
};

/// The scene after a frame.
struct SceneOutput
{
    std::uint32_t objects{0};       ///< That are there.
    std::uint32_t pairs{0};         ///< Awake: those that have a PairOutput.
    std::uint32_t crowded_tools{0}; ///< That are not proven clear as far as they ask.
    /// Of those, and of tools before a model that isn't resident: with a hand that is farther.
    std::uint32_t walled_tools{0};
    std::uint32_t walks{0}; ///< Over all objects: at most kBroadWalks.
    /// Changes that were not made, in the order of ChangeRefusal.
    std::array<std::uint32_t, kChangeRefusals> refused{};
};

/// Use of one pool now, in slots.
struct PoolUse
{
    std::uint32_t used{0};
    std::uint32_t used_max{0}; ///< Since the start; of index pages what is used now.
    std::uint32_t capacity{0}; ///< What the model brought: it may use more.
};

/// Where a model is in its life. Those with which a frame starts as a whole stay `resident`.
enum class ModelStage : std::uint8_t
{
    known,    ///< Its header is here. No tool is near, or the pools have no room for it.
    wanted,   ///< A tool is near: its base mesh was asked for.
    arriving, ///< It is here and enters the tree.
    resident, ///< Its surface answers.
    leaving,  ///< No tool is near: it is taken out of the pools.
};
inline constexpr std::uint32_t kModelStages = 5;
/// In the order of ModelStage.
inline constexpr std::array<const char*, kModelStages> kModelStageNames{
    "known", "wanted", "arriving", "resident", "leaving"};

/// One model's state after the frame.
struct ModelOutput
{
    PoolUse pages;
    PoolUse index_pages;
    PoolUse faces;
    PoolUse blocks;
    PoolUse nodes;
    std::uint32_t refined_records{0};
    std::uint64_t state_hash{0}; ///< Names the active faces: the same cut has the same.
    bool is_static{false};       ///< Refined fully: nothing is left to load, refine or refit.
    ModelStage stage{ModelStage::resident};
};

/// What a frame returns: spans into the frame's own memory, valid until the next run.
struct FrameOutput
{
    std::span<const ToolOutput> tools;   ///< In set-up order.
    std::span<const PairOutput> pairs;   ///< Of what is near: tool by tool, in each the objects by
                                         ///< their numbers; the nearest one always.
    std::span<const ModelOutput> models; ///< In set-up order.
    WorkCounters work;
    FrameFault faults{FrameFault::none};
    DoorTake door; ///< An input of the frame, kept for recordings.
    SceneOutput scene;
};

} // namespace tactus
