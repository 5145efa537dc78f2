// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/force/material_blend.hpp"
#include "rt_core/frame/mesh_pair.hpp"
#include "rt_core/frame/tool.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/predict/region_predictor.hpp"
#include "rt_core/query/pair_front.hpp"
#include "rt_core/query/query_memory.hpp"
#include "rt_core/query/surface_query.hpp"
#include "rt_core/records/contact.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"
#include "rt_core/records/frame_variant.hpp"
#include "rt_core/records/local_surface.hpp"
#include "rt_core/records/region_ranking.hpp"
#include "rt_core/refine/refine_question.hpp"
#include "rt_core/refine/surface_tolerance.hpp"
#include "rt_core/scene/object_table.hpp"
#include "rt_core/scene/region_of_interest.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace tactus
{

struct Model;

/// Common settings of all pairs of a frame.
struct PairRules
{
    std::int64_t period_ns{1'000'000};
    std::int64_t pose_age_max_ns{0};
    Prediction prediction{Prediction::automatic};
    double force_tolerance_n{0.0};
    FrameVariant variant;
    std::int64_t now_ns{0}; ///< Time of this frame, on the clock of ObjectPose::arrival_ns.
    std::uint32_t frame{0};
    WorkBudget* work{nullptr}; ///< Budget of this frame's work.
};

/// Model and its id in the frame.
struct NamedModel
{
    ModelId id{};
    const Model* model{nullptr};
};

/// Tool, object and models of a pair; all of them outlive the pair.
struct PairParts
{
    std::uint32_t tool_index{0};
    std::uint32_t object_number{0};
    const PairRules* rules{nullptr};
    const Tool* tool{nullptr};
    const Object* object{nullptr}; ///< The object, whose present state can always be read here.
    /// True if tool and object may have passed through each other: no force until the two are
    /// proven apart.
    bool begins_apart{false};
    NamedModel model;      ///< Model of the object.
    NamedModel tool_model; ///< Model of a tool that is a mesh; none for others.
};

/// Free memory for the triangles that queries find.
struct SurfaceRoom
{
    std::span<LocalTriangle> triangles;
    std::span<double> distances_m;

    /// Empty surface with as much of the memory as one surface may use.
    [[nodiscard]] LocalSurface surface() const noexcept
    {
        TACTUS_ASSERT(triangles.size() == distances_m.size());
        LocalSurface surface;
        const std::size_t most = std::min<std::size_t>(triangles.size(), kMaxLocalTriangles);
        surface.triangles = triangles.first(most);
        surface.distances_m = distances_m.first(most);
        return surface;
    }
    [[nodiscard]] SurfaceRoom after(std::uint32_t count) const noexcept
    {
        TACTUS_ASSERT(count <= triangles.size());
        return {triangles.subspan(count), distances_m.subspan(count)};
    }
};

/// Memory that some pairs have besides Pair, by the index of the pair. Spans are empty if no tool
/// needs them.
struct PairMemory
{
    std::span<ContactReport> contacts; ///< Reports of tools that want contacts or are meshes.
    std::span<TouchReport> touches;    ///< Reports of rigid tools.
    std::span<MeshPair> meshes;        ///< Data of mesh tools.
    std::span<PairFront> fronts; ///< Fronts for the pairs of mesh tools with highest priority.

    [[nodiscard]] static PairMemory take(Arena& arena, std::span<const ToolSpec> tools,
                                         std::size_t pairs) noexcept;
};

/// Largest number of questions of a pair to its object's model in a frame: two for each sphere of
/// the cover (present and predicted place), and one for the distance.
inline constexpr std::size_t kPairQuestions = std::size_t{2} * kMaxCoverSpheres + 1;
/// Largest number of requests in a frame: one to each pair's object, and one to each pair's mesh
/// tool.
inline constexpr std::size_t kMaxRequests = std::size_t{2} * kMaxPairs;
using RefineRequests = StaticVector<RefineRequest, kMaxRequests>;

/// State of one tool at one object, kept from frame to frame. Haptic thread; the functions are in
/// the order of their calls in a frame. 5.3 KiB without the memory of PairMemory.
class Pair
{
public:
    Pair() noexcept = default;
    Pair(const PairParts& parts, const PairMemory& memory,
         std::size_t index) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] const PairParts& parts() const noexcept { return parts_; }
    [[nodiscard]] std::uint32_t tool() const noexcept { return parts_.tool_index; }
    [[nodiscard]] std::uint32_t object() const noexcept { return parts_.object_number; }
    /// Model of the object.
    [[nodiscard]] ModelId model() const noexcept { return parts_.model.id; }

    /// Updates the pair for the poses of tool and object in this frame.
    void place(const Budgets& budgets) noexcept TACTUS_NONBLOCKING;
    /// Priority of the pair, as found by place().
    [[nodiscard]] const Priority& priority() const noexcept { return priority_; }

    /// Disables loading and refinement for this pair, or, with false, enables them.
    void shed(bool is_shed) noexcept { is_shed_ = is_shed; }
    /// True if the pair's tool is not proven out of reach, so that shedding the pair would save
    /// work.
    [[nodiscard]] bool is_awake() const noexcept { return !region_of_interest_.is_asleep(); }
    [[nodiscard]] bool is_of_mesh() const noexcept { return mesh_ != nullptr; }
    /// Calls MeshPair::exchange_front(); the tool must be a mesh (asserted).
    PairFront* exchange_front(PairFront* front) noexcept TACTUS_NONBLOCKING
    {
        TACTUS_ASSERT(mesh_ != nullptr);
        return mesh_->exchange_front(front);
    }

    /// Adds the regions that the tool may touch soon to the ranking, unless the pair's models are
    /// resident as a whole.
    void rank(RegionRanking& ranking) noexcept TACTUS_NONBLOCKING;
    /// Adds the region that a requested distance needs (ToolSpec::wants_distance), behind those
    /// that tools may touch.
    void rank_distance(RegionRanking& ranking) const noexcept TACTUS_NONBLOCKING;

    /// Adds the pair's questions to `requests`: about the tool's place and, if it approaches, its
    /// future place. Certificates of all other questions are dropped, as a model may coarsen there.
    void ask(RefineRequests& requests) noexcept TACTUS_NONBLOCKING;

    /// True, after ask(), if capacity for the surface in reach is short, which merges relieve.
    [[nodiscard]] bool is_short() const noexcept
    {
        return room_ == SurfaceTolerance::Room::short_ && tolerance_.code() != 0;
    }
    /// True if the object's model is, or will be, resident as a whole, but is too fine for the
    /// pair's tolerance.
    [[nodiscard]] bool needs_coarser_model() const noexcept TACTUS_NONBLOCKING;

    /// Queries the distance and the surface that the tool's force needs. Triangles are stored at
    /// the beginning of `room`; returns the rest of it.
    [[nodiscard]] SurfaceRoom query(const SurfaceRoom& room, const Budgets& budgets,
                                    WorkCounters& work,
                                    FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    /// Repeats the query from the tool's new place in the same frame. Triangles of a sphere are
    /// stored in the larger of the previous query's memory and `room`. Returns the rest of
    /// `room`.
    [[nodiscard]] SurfaceRoom query_again(const SurfaceRoom& room, const Budgets& budgets,
                                          WorkCounters& work,
                                          FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    /// Repeats the last frame's query without any effect; see Frame::warm_caches().
    void warm_caches(const SurfaceRoom& room, const Budgets& budgets,
                     WorkBudget& work) const noexcept TACTUS_NONBLOCKING;

    /// True if, in this frame, the object's model isn't resident and its box is within the tool's
    /// reach: the tool stops there.
    [[nodiscard]] bool is_wall() const noexcept
    {
        return !is_model_here_ && lower_m_ <= parts_.tool->placement().reach_m;
    }

    /// True if the object's model may be removed in spite of the pair: no contact is expected soon,
    /// and the model's box is out of the tool's reach.
    [[nodiscard]] bool can_spare_model() const noexcept TACTUS_NONBLOCKING;
    /// Ends the validity of what was known of the object's surface, which an edit has changed.
    void invalidate() noexcept TACTUS_NONBLOCKING;
    /// Makes a tool that an added face enters ignore the object until both are apart.
    void ignore_if_entered(const SurfaceEdit& edit) noexcept TACTUS_NONBLOCKING;
    /// Makes the pair answer from the model's box, since the model leaves. Closures must have been
    /// released.
    void lose_model() noexcept TACTUS_NONBLOCKING;

    /// False until tool and object, which may have passed through each other, are proven apart: the
    /// tool then ignores the object.
    [[nodiscard]] bool is_joined() const noexcept { return is_joined_; }
    /// Surface found by query(), for the tool.
    [[nodiscard]] PlacedSurface placed() noexcept TACTUS_NONBLOCKING;
    /// True if the object was added or moved in this frame.
    [[nodiscard]] bool has_moved() const noexcept
    {
        return parts_.object->moved_frame == parts_.rules->frame;
    }
    /// The object with its poses before and after this frame's changes.
    [[nodiscard]] NearObject near() noexcept
    {
        const ObjectPose& now = parts_.object->pose;
        return {parts_.object_number, has_moved() ? &last_pose_ : &now, &now, &body_, lower_m_};
    }
    /// Clears the velocities of an object at rest.
    void clear_velocities() noexcept
    {
        body_.velocity_m_per_s = Vec3(0.0, 0.0, 0.0);
        body_.spin_rad_per_s = Vec3(0.0, 0.0, 0.0);
    }
    /// True if query() would repeat its last result for a tool at the same place.
    [[nodiscard]] bool is_unchanged() const noexcept TACTUS_NONBLOCKING;
    /// Stores the object's pose as the previous one, at the end of a frame.
    void remember() noexcept
    {
        if (has_moved())
        {
            last_pose_ = parts_.object->pose;
        }
    }
    /// Closures of the two models' questions, which must be released before the pair ends.
    [[nodiscard]] Closure& object_closure() noexcept { return of_object_.closure; }
    [[nodiscard]] Closure& tool_closure() noexcept { return of_tool_.closure; }
    /// Result of query(), for the frame's output.
    [[nodiscard]] PairOutput output() const noexcept TACTUS_NONBLOCKING;

private:
    /// Questions of the pair to one of its models in this frame.
    template <std::size_t Capacity>
    struct Inquiry
    {
        StaticVector<RefineQuestion, Capacity> questions;
        Closure closure;
        ErrorCode tolerance{0}; ///< Largest error of faces that need not be split.
    };

    [[nodiscard]] std::uint32_t revision() const noexcept;
    void forget_refinement() noexcept;
    void update_region() noexcept;
    void find_priority() noexcept;
    [[nodiscard]] PairMotion motion() const noexcept;
    void fit_tolerance() noexcept;
    [[nodiscard]] SurfaceTolerance::Range tolerance_range() const noexcept;
    [[nodiscard]] SurfaceTolerance::Room surface_room() const noexcept;
    /// Reasons for which the questions to both models were not served in the last frame.
    [[nodiscard]] FrameFault late_for() const noexcept
    {
        return of_object_.closure.late_for | of_tool_.closure.late_for;
    }
    [[nodiscard]] bool would_finer_fit() const noexcept;
    void note_work_left(const WorkBudget& budget) noexcept;
    void ask_for_spheres() noexcept;
    void ask_for_distance() noexcept;
    [[nodiscard]] bool tells_distance() const noexcept
    {
        return parts_.tool->spec().wants_distance && mesh_ == nullptr;
    }
    [[nodiscard]] ProofShare proof_share() const noexcept
    {
        return tells_distance() ? ProofShare::all : ProofShare::most;
    }
    [[nodiscard]] std::uint32_t enough_meeting() const noexcept;
    [[nodiscard]] double distance_reach_m() const noexcept;
    [[nodiscard]] bool measures_from_afar() const noexcept;
    [[nodiscard]] RefineQuestion ahead_of(RefineQuestion question) const noexcept;
    void ask_for_mesh() noexcept;
    template <std::size_t Capacity>
    void ask(bool is_asked, const Model& model, const RefineQuestion& question,
             Inquiry<Capacity>& inquiry) const noexcept;
    template <std::size_t Capacity>
    void request(const NamedModel& model, Inquiry<Capacity>& inquiry,
                 RefineRequests& requests) const noexcept;
    /// Distances of the tool's core from the model's box, in its frame: nearest and farthest.
    struct BoxGap
    {
        double lower_m{0.0};
        double upper_m{0.0};
    };
    [[nodiscard]] BoxGap gap_to_box() const noexcept TACTUS_NONBLOCKING;
    void query_box() noexcept TACTUS_NONBLOCKING;
    void query_core(const Budgets& budgets, WorkCounters& work, FrameFault& faults) noexcept;
    void gather(QueryMemory& memory, WalkBudget& budget, LocalSurface& surface) const noexcept;
    void narrow(DistanceAnswer& answer) const noexcept;
    void report_core(WorkCounters& work) noexcept;
    void query_mesh(WorkCounters& work, FrameFault& faults) noexcept;
    [[nodiscard]] double rounding_m() const noexcept;

    PairParts parts_;
    LocalSurface surface_; ///< Surface of this frame; its triangles are in the frame's SurfaceRoom.
    ContactReport* contacts_{nullptr}; ///< Null unless the tool wants contacts or is a mesh.
    TouchReport* touches_{nullptr};    ///< Null unless the tool is rigid.
    MeshPair* mesh_{nullptr};          ///< Null unless the tool is a mesh.
    RegionOfInterest region_of_interest_;
    Similarity asked_;             ///< Pose of the tool at the last query, in the world.
    Vec3 device_m_{0.0, 0.0, 0.0}; ///< Goal of the tool in the last frame, in the model's frame.
    Priority priority_;
    bool is_shed_{false};
    bool is_joined_{true};
    bool may_be_entered_{false}; ///< True if an added face may meet the mesh tool.
    bool is_model_here_{true};   ///< True if the object's model is resident in this frame.
    ObjectPose last_pose_;       ///< Pose of the object in the last frame.
    ProxyMemory body_;
    MaterialBlend material_;
    bool has_material_changed_{false}; ///< True if the felt material differs from the last frame's.
    SurfaceTolerance tolerance_;
    /// Capacity for the surface, as found in the last frame.
    SurfaceTolerance::Room room_{SurfaceTolerance::Room::fitting};
    /// True if the frame had half as much work left as it had used at the end of this query.
    bool had_work_left_{true};
    bool was_answered_{false};           ///< True if the last query ended within its budgets.
    std::uint32_t answered_revision_{0}; ///< Value of revision() at the last query.
    RegionPredictor predictor_;
    std::array<RefineMemory, kPairQuestions> refine_memories_{};
    Inquiry<kPairQuestions> of_object_;
    Inquiry<MeshPair::kPlaces> of_tool_; ///< Questions to the tool's model, if it is a mesh.
    QueryMemory query_memory_;
    /// Lower and upper bound of the distance in the world, widened by the rounding of the
    /// conversion.
    double lower_m_{0.0};
    double upper_m_{0.0};
};

} // namespace tactus
