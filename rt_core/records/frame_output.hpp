// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"
#include "rt_core/records/contact.hpp"
#include "rt_core/records/local_surface.hpp"
#include "rt_core/records/mesh_report.hpp"
#include "rt_core/records/queue_event.hpp"
#include "rt_core/records/scene_change.hpp"
#include "rt_core/records/surface_edit.hpp"
#include "rt_core/records/work_counters.hpp"

#include <array>
#include <cstdint>
#include <span>

// Usable on any thread: plain values and pure functions. No call waits or allocates.
namespace tactus
{

/// Results of one tool. World frame, SI.
///
/// Force and torque are those of the proxy's spring, even with a fault. ForceFader fades them for
/// each fault of faults_of().
struct ToolOutput
{
    Vec3 force_n{0.0, 0.0, 0.0};
    /// Position of the proxy: the tool's origin where surfaces allow it.
    Vec3 proxy_m{0.0, 0.0, 0.0};
    Vec3 torque_nm{0.0, 0.0, 0.0}; ///< Torque about the device's position; zero for a sphere.
    Mat3 proxy_rotation{Mat3::Identity()}; ///< Rotation of the proxy; for a sphere the device's.
    /// Stiffness of the spring that produces the force; 0 without contact.
    double stiffness_n_per_m{0.0};
    /// Path that the proxy still has to the goal, along the surface in contact; 0 at rest.
    double lag_m{0.0};
    bool in_contact{false};
    bool halted{false};           ///< The proxy waits for data and is halted.
    bool over_constrained{false}; ///< Objects leave the tool no room.
    /// Data-limited: the proxy reached the end of the known surface before its goal.
    bool data_limited{false};
    /// The proxy would move on: it reached the end of the known surface or of a frame's steps.
    bool under_way{false};
    bool cut_short{false}; ///< The proxy would move on: the frame's checks were used up.
    /// More contacts than limits allow: force and torque may lack some.
    bool capacity_exceeded{false};
    /// An object near the touching tool was removed or jumped, or an edit removed its surface.
    bool lost_object{false};
    /// The tool was removed (SceneChangeKind::tool_goes); all other values are defaults.
    bool is_gone{false};
    /// Largest displacement since the last frame of points of an object within the tool's reach,
    /// and largest rotation angle of such an object. >= 0.
    double object_way_m{0.0};
    double object_rotation_rad{0.0};
    /// Displacement and rotation vector by which moving objects carried the proxy in this frame.
    /// The force's work along them is done by the movers of the objects, not by the wall.
    Vec3 carried_m{0.0, 0.0, 0.0};
    Vec3 carried_rad{0.0, 0.0, 0.0};
    /// Proven distance of the core, with the proxy at its place at the start of the frame, from all
    /// objects without a PairOutput. Infinite if there is no such object.
    double clear_m{kInfinity};
    FrameFault sample_fault{FrameFault::none}; ///< Fault of the device's samples (SampleWatch).

    [[nodiscard]] bool operator==(const ToolOutput&) const = default;
};

/// Faults that a frame reports for a tool with this output.
[[nodiscard]] constexpr FrameFault frame_faults(const ToolOutput& output) noexcept
{
    return output.sample_fault | (output.halted ? FrameFault::proxy_halted : FrameFault::none) |
           (output.over_constrained ? FrameFault::proxy_over_constrained : FrameFault::none) |
           (output.capacity_exceeded ? FrameFault::tool_over_capacity : FrameFault::none) |
           (output.cut_short ? FrameFault::plane_budget_spent : FrameFault::none) |
           (output.lost_object ? FrameFault::object_lost : FrameFault::none);
}

/// Faults for which a tool's force must fade. A halted proxy without contact has no force to fade;
/// an over-constrained one will have a force as soon as it touches.
[[nodiscard]] constexpr FrameFault faults_of(const ToolOutput& output) noexcept
{
    const bool is_held = output.halted && output.in_contact;
    return output.sample_fault | (output.lost_object ? FrameFault::object_lost : FrameFault::none) |
           (is_held ? FrameFault::proxy_halted : FrameFault::none) |
           (output.over_constrained ? FrameFault::proxy_over_constrained : FrameFault::none);
}

/// Results of one pair of tool and object. World frame and metres: distances of the model's frame
/// times the object's scale.
struct PairOutput
{
    std::uint32_t tool{0};
    std::uint32_t object{0};
    AnswerKind kind{AnswerKind::bounded};
    /// Position of the tool for which the answer holds: at the start of the frame, or of its last
    /// step with work left for this pair. Pairs of one tool may differ.
    Vec3 tool_m{0.0, 0.0, 0.0};
    Mat3 tool_rotation{Mat3::Identity()}; ///< Rotation of the tool at tool_m.
    /// Point of the core at tool_m nearest to the surface; the core's centre if unknown.
    Vec3 point_m{0.0, 0.0, 0.0};
    double lower_m{0.0}; ///< L: lower bound on the distance from the core, >= 0.
    double upper_m{0.0}; ///< U: upper bound on the distance from the core; infinite if unknown.
    /// All original faces within this distance of the core are active and exact, or represented by
    /// faces with an error of at most tolerated_m.
    double certified_radius_m{0.0};
    /// Largest error of a face that counts as the surface, plus what faces that were not measured
    /// may change; 0: all are exact. L is at most twice this below the distance.
    double tolerated_m{0.0};
    FaceId nearest_face{};               ///< None if no surface is in reach.
    Vec3 nearest_point_m{0.0, 0.0, 0.0}; ///< Point of nearest_face; undefined without one.
    bool skipped{false}; ///< True if the answer follows from the last one and the motion since.
    /// Feature of nearest_face at the nearest point.
    TriangleFeature nearest_feature{TriangleFeature::interior};
    /// The pair is neither loaded nor refined: higher-priority pairs took the capacity.
    bool is_shed{false};
    /// False: tool and object may have passed through each other. The object makes no force until
    /// the two are proven apart.
    bool is_joined{true};
    double damping_n_s_per_m{0.0};          ///< Damping of the object's material, as felt now.
    const ContactReport* contacts{nullptr}; ///< Null unless the tool asks for contacts.
    const MeshReport* mesh{nullptr};        ///< Null unless the tool is a mesh.
};

/// The scene after a frame.
struct SceneOutput
{
    std::uint32_t objects{0}; ///< Objects in the scene.
    std::uint32_t pairs{0};   ///< Pairs of tools and near objects, each with a PairOutput.
    /// Tools whose proven clearance is less than their reach.
    std::uint32_t tools_over_capacity{0};
    /// Tools that stop short of the device pose, over capacity or at a model that is not resident.
    std::uint32_t walled_tools{0};
    std::uint32_t walks{0}; ///< Searches of all objects for those near a tool; at most kBroadWalks.
    /// Changes that were refused, in the order of ChangeRefusal.
    std::array<std::uint32_t, kChangeRefusals> refused{};
    /// Edits of surfaces that were refused, in the order of EditRefusal.
    std::array<std::uint32_t, kEditRefusals> edits_refused{};
};

/// Present use of one pool, in slots.
struct PoolUse
{
    std::uint32_t used{0};
    /// Maximum of `used` since the start; for index pages the present value.
    std::uint32_t used_max{0};
    std::uint32_t capacity{0}; ///< Slots reserved for the model, which may use more.
};

/// Life cycle of a model. A model that is not streamed is always `resident`.
enum class ModelStage : std::uint8_t
{
    known,    ///< Only the header is loaded. No tool is near, or the pools have no room.
    wanted,   ///< A tool is near: the base mesh was requested.
    arriving, ///< The base mesh is loaded, and its faces enter the tree.
    resident, ///< The surface answers queries.
    leaving,  ///< No tool is near: the model is removed from the pools.
};
inline constexpr std::uint32_t kModelStages = 5;
/// Names of the stages, in the order of ModelStage.
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
    std::uint64_t state_hash{0}; ///< Hash of the active faces: equal cuts have equal hashes.
    bool is_static{false};       ///< Refined fully: nothing is left to load, refine or refit.
    ModelStage stage{ModelStage::resident};
    PoolUse added;                  ///< Faces that edits added.
    std::uint32_t edit_revision{0}; ///< Number of the model's last edit; 0: none.
};

/// Results of a frame: spans into the frame's own memory, valid until the next run.
struct FrameOutput
{
    std::span<const ToolOutput> tools; ///< Set-up order.
    /// Pairs of each tool with the objects near it, always with the nearest object. Sorted by tool,
    /// then by object number.
    std::span<const PairOutput> pairs;
    std::span<const ModelOutput> models; ///< Set-up order.
    WorkCounters work;
    FrameFault faults{FrameFault::none};
    QueueTake queues; ///< Events taken from the queues: an input of the frame, kept for recordings.
    SceneOutput scene;
};

} // namespace tactus
