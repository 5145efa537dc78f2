// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/force/material_blend.hpp"
#include "rt_core/frame/mesh_pair.hpp"
#include "rt_core/frame/model.hpp"
#include "rt_core/frame/tool.hpp"
#include "rt_core/predict/region_predictor.hpp"
#include "rt_core/query/block_search.hpp"
#include "rt_core/query/surface_query.hpp"
#include "rt_core/records/frame_variant.hpp"
#include "rt_core/refine/refine_question.hpp"
#include "rt_core/refine/surface_tolerance.hpp"
#include "rt_core/scene/object_table.hpp"
#include "rt_core/scene/region_of_interest.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tactus
{

/// Common settings of all pairs of a frame.
struct PairRules
{
    std::int64_t period_ns{1'000'000};
    std::int64_t pose_age_max_ns{0};
    Prediction prediction{Prediction::automatic};
    double force_tolerance_n{0.0};
    FrameVariant variant;
    std::int64_t now_ns{0}; ///< Time of this frame.
    std::uint32_t frame{0};
    WorkBudget* work{nullptr}; ///< Work of this frame.
};

/// A model and its id in the frame.
struct NamedModel
{
    ModelId id{};
    const Model* model{nullptr};
};

/// Parts of a pair, which outlive it.
struct PairParts
{
    std::uint32_t tool_index{0};
    std::uint32_t object_number{0};
    const PairRules* rules{nullptr};
    const Tool* tool{nullptr};
    const Object* object{nullptr}; ///< Always in its present state.
    /// One passed round the other: no force until they are proven apart.
    bool begins_apart{false};
    NamedModel model;      ///< Model of the object.
    NamedModel tool_model; ///< Model of a tool that is a mesh; none for others.
};

/// Memory for the triangles of pairs' surfaces.
struct SurfaceRoom
{
    std::span<LocalTriangle> triangles;
    std::span<double> distances_m;

    /// A surface with the largest capacity left for one.
    [[nodiscard]] LocalSurface surface() const noexcept
    {
        LocalSurface surface;
        const std::size_t most = std::min<std::size_t>(triangles.size(), kMaxLocalTriangles);
        surface.triangles = triangles.first(most);
        surface.distances_m = distances_m.first(most);
        return surface;
    }
    [[nodiscard]] SurfaceRoom after(std::uint32_t count) const noexcept
    {
        return {triangles.subspan(count), distances_m.subspan(count)};
    }
};

/// Memory of pairs outside of them, by their index. Empty if no tool needs it.
struct PairMemory
{
    std::span<ContactReport> contacts; ///< Used by tools that want contacts or are meshes.
    std::span<TouchReport> touches;    ///< Used by rigid tools.
    std::span<MeshPair> meshes;        ///< Used by tools that are meshes.
    std::span<PairFront> fronts;       ///< Used by those of highest priority.

    [[nodiscard]] static PairMemory take(Arena& arena, std::span<const ToolSpec> tools,
                                         std::size_t pairs) noexcept;
};

/// Questions of a pair to its object's model in a frame: for each sphere its present and its
/// predicted place, and one for the distance.
inline constexpr std::size_t kPairQuestions = std::size_t{2} * kMaxCoverSpheres + 1;
/// One per pair, and one more for a tool that is a mesh.
inline constexpr std::size_t kMaxRequests = std::size_t{2} * kMaxPairs;
using RefineRequests = StaticVector<RefineRequest, kMaxRequests>;

/// State of one tool and one object that is kept from frame to frame. Haptic thread; the functions
/// in the frame's order. 5.3 KiB besides its parts.
class Pair
{
public:
    Pair() noexcept = default;
    Pair(const PairParts& parts, const PairMemory& memory,
         std::size_t index) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] const PairParts& parts() const noexcept { return parts_; }
    [[nodiscard]] std::uint32_t tool() const noexcept { return parts_.tool_index; }
    [[nodiscard]] std::uint32_t object() const noexcept { return parts_.object_number; }

    /// Updates the pair for the poses of tool and object in this frame.
    void place(const Budgets& budgets) noexcept TACTUS_NONBLOCKING;
    /// Priority found by place().
    [[nodiscard]] const Priority& priority() const noexcept { return priority_; }

    /// Enables or disables loading and refinement for this pair.
    void shed(bool is_shed) noexcept { is_shed_ = is_shed; }
    /// True if shedding the pair would save anything.
    [[nodiscard]] bool is_awake() const noexcept { return !region_of_interest_.is_asleep(); }
    [[nodiscard]] bool is_of_mesh() const noexcept { return mesh_ != nullptr; }
    /// MeshPair::exchange_front(), for a tool that is a mesh.
    PairFront* exchange_front(PairFront* front) noexcept TACTUS_NONBLOCKING
    {
        TACTUS_ASSERT(mesh_ != nullptr);
        return mesh_->exchange_front(front);
    }

    /// Adds the regions that the pair may touch soon to the ranking, unless its models are resident
    /// as a whole.
    void rank(RegionRanking& ranking) noexcept TACTUS_NONBLOCKING;
    /// Adds the regions that its distance needs (ToolSpec::wants_distance), behind those that all
    /// pairs may touch.
    void rank_distance(RegionRanking& ranking) const noexcept TACTUS_NONBLOCKING;

    /// Adds the pair's questions to its models: for the tool's place and, if it approaches, for its
    /// future place. Certificates of unrequested questions are dropped: a model may coarsen there.
    void ask(RefineRequests& requests) noexcept TACTUS_NONBLOCKING;

    /// True, after ask(), if too much surface is in reach, which merges reduce.
    [[nodiscard]] bool is_short() const noexcept
    {
        return room_ == SurfaceTolerance::Room::short_ && tolerance_.code() != 0;
    }
    /// True if the pair's model is, or will be, resident as a whole.
    [[nodiscard]] bool needs_coarser_model() const noexcept TACTUS_NONBLOCKING;

    /// Queries the distance and the surface that the tool's force needs: triangles are stored from
    /// the room's beginning on. Returns the remaining room.
    [[nodiscard]] SurfaceRoom query(const SurfaceRoom& room, const Budgets& budgets,
                                    WorkCounters& work,
                                    FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    /// Repeats the query in the same frame, from the tool's new place; nothing is refined between.
    /// A proxy's triangles need a separate room: its previous one, or the one given. Returns the
    /// rest of that.
    [[nodiscard]] SurfaceRoom query_again(const SurfaceRoom& room, const Budgets& budgets,
                                          WorkCounters& work,
                                          FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    /// Repeats the last frame's query with its stored state; see Frame::warm_caches().
    void warm_caches(const SurfaceRoom& room, const Budgets& budgets,
                     WorkBudget& work) const noexcept TACTUS_NONBLOCKING;

    /// True if, in this frame, the object's model isn't resident and its box is in the tool's
    /// reach: the tool stops there.
    [[nodiscard]] bool is_wall() const noexcept
    {
        return !is_model_here_ && lower_m_ <= parts_.tool->placement().reach_m;
    }

    /// True if the object's model may be removed in spite of the pair: no contact is near, and its
    /// box is not in the tool's reach.
    [[nodiscard]] bool can_spare_model() const noexcept TACTUS_NONBLOCKING;
    /// Removes the model from the pair, whose closures have been released: it answers from the box.
    void lose_model() noexcept TACTUS_NONBLOCKING;

    /// True if the tool takes the object into account.
    [[nodiscard]] bool is_joined() const noexcept { return is_joined_; }
    /// Result of query(), for the tool.
    [[nodiscard]] PlacedSurface placed() noexcept TACTUS_NONBLOCKING;
    /// True if the object was added or moved in this frame.
    [[nodiscard]] bool has_moved() const noexcept
    {
        return parts_.object->moved_frame == parts_.rules->frame;
    }
    /// The object before and after the changes of this frame.
    [[nodiscard]] NearObject near() noexcept
    {
        const ObjectPose& now = parts_.object->pose;
        return {parts_.object_number, has_moved() ? &stood_ : &now, &now, &body_, lower_m_};
    }
    /// Clears the velocities of an object at rest.
    void stand() noexcept
    {
        body_.velocity_m_per_s = Vec3(0.0, 0.0, 0.0);
        body_.spin_rad_per_s = Vec3(0.0, 0.0, 0.0);
    }
    /// True if query() would repeat its last result for a tool at the same place.
    [[nodiscard]] bool is_unchanged() const noexcept TACTUS_NONBLOCKING;
    /// Ends the frame: keeps the object's pose as the previous one.
    void remember() noexcept
    {
        if (has_moved())
        {
            stood_ = parts_.object->pose;
        }
    }
    /// Closures that must be released before the pair ends.
    [[nodiscard]] Closure& object_closure() noexcept { return of_object_.closure; }
    [[nodiscard]] Closure& tool_closure() noexcept { return of_tool_.closure; }
    /// Result of query(), for the frame's output.
    [[nodiscard]] PairOutput output() const noexcept TACTUS_NONBLOCKING;

private:
    /// Questions of the pair to one of its models.
    template <std::size_t Capacity>
    struct Inquiry
    {
        StaticVector<RefineQuestion, Capacity> questions;
        Closure closure;
    };

    [[nodiscard]] std::uint32_t revision() const noexcept;
    void look() noexcept;
    void find_priority() noexcept;
    [[nodiscard]] PairMotion motion() const noexcept;
    void fit_tolerance() noexcept;
    [[nodiscard]] SurfaceTolerance::Range tolerance_range() const noexcept;
    [[nodiscard]] SurfaceTolerance::Room surface_room() const noexcept;
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
    void narrow(DistanceAnswer& answer) const noexcept;
    void report_core(WorkCounters& work) noexcept;
    void query_mesh(WorkCounters& work, FrameFault& faults) noexcept;
    [[nodiscard]] double rounding_m() const noexcept;

    PairParts parts_;
    LocalSurface surface_;             ///< Stored in the frame's room, for this frame.
    ContactReport* contacts_{nullptr}; ///< Null unless the tool wants them or is a mesh.
    TouchReport* touches_{nullptr};    ///< Null unless the tool is rigid.
    MeshPair* mesh_{nullptr};          ///< Null unless the tool is a mesh.
    RegionOfInterest region_of_interest_;
    Similarity asked_;           ///< Pose of the tool at the last query, in the world.
    Vec3 hand_m_{0.0, 0.0, 0.0}; ///< Device goal in the model's frame, in the last frame.
    Priority priority_;
    bool is_shed_{false};
    bool is_joined_{true};
    bool is_model_here_{true}; ///< State of this frame.
    ObjectPose stood_;         ///< Object's pose in the last frame.
    ProxyMemory body_;
    MaterialBlend feel_;
    bool feels_otherwise_{false}; ///< Differs from the last frame.
    SurfaceTolerance tolerance_;
    SurfaceTolerance::Room room_{SurfaceTolerance::Room::fitting}; ///< Result of the last frame.
    /// The frame had work left for half as much again as it had used when this query ended.
    bool had_work_left_{true};
    bool was_answered_{false};           ///< Answered by the last query, within its budgets.
    std::uint32_t answered_revision_{0}; ///< Revision of its models at that time.
    RegionPredictor predictor_;
    std::array<RefineMemory, kPairQuestions> refine_memories_{};
    Inquiry<kPairQuestions> of_object_;
    Inquiry<MeshPair::kPlaces> of_tool_; ///< Used if the tool is a mesh.
    QueryMemory query_memory_;
    /// Bounds of the answer in the world, widened by the rounding of the conversion.
    double lower_m_{0.0};
    double upper_m_{0.0};
};

} // namespace tactus
