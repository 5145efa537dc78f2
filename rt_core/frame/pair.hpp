// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/force/material_glide.hpp"
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
#include "rt_core/scene/outlook.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tactus
{

/// What all pairs of a frame go by.
struct PairRules
{
    std::int64_t period_ns{1'000'000};
    std::int64_t pose_age_max_ns{0};
    Prediction prediction{Prediction::automatic};
    double force_tolerance_n{0.0};
    FrameVariant variant;
    std::int64_t now_ns{0}; ///< This frame's.
    std::uint32_t frame{0};
    WorkBudget* work{nullptr}; ///< This frame's.
};

/// A model and its name in the frame.
struct NamedModel
{
    ModelId id{};
    const Model* model{nullptr};
};

/// Whom a pair brings together; all of it outlives the pair.
struct PairParts
{
    std::uint32_t tool_index{0};
    std::uint32_t object_number{0};
    const PairRules* rules{nullptr};
    const Tool* tool{nullptr};
    const Object* object{nullptr}; ///< As it is in this frame, whenever a function is called.
    /// One of them has come round the other: no force until they are proven apart.
    bool begins_apart{false};
    NamedModel model;      ///< Of the object.
    NamedModel tool_model; ///< Of a tool that is a mesh; none for other tools.
};

/// Where a frame's pairs put the triangles of their surfaces.
struct SurfaceRoom
{
    std::span<LocalTriangle> triangles;
    std::span<double> distances_m;

    /// A surface with as much room as is left for one.
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

/// What pairs keep beside themselves, each at its own index. Empty where no tool needs it.
struct PairMemory
{
    std::span<ContactReport> contacts; ///< For tools that want them or are meshes.
    std::span<TouchReport> touches;    ///< For tools that are held as bodies.
    std::span<MeshPair> meshes;        ///< For tools that are meshes.
    std::span<PairFront> fronts;       ///< For the most urgent of these.

    [[nodiscard]] static PairMemory take(Arena& arena, std::span<const ToolSpec> tools,
                                         std::size_t pairs) noexcept;
};

/// What a pair asks of its object's model in a frame: of each ball where it is and where it will
/// be, and once for the distance.
inline constexpr std::size_t kPairQuestions = std::size_t{2} * kMaxCoverBalls + 1;
/// One a pair, and one more of a tool that is a mesh.
inline constexpr std::size_t kMaxRequests = std::size_t{2} * kMaxPairs;
using RefineRequests = StaticVector<RefineRequest, kMaxRequests>;

/// One tool and one object: where they are to each other, and what is known of it from frame to
/// frame. Haptic thread; the functions in the frame's order. 5.3 KiB beside its parts.
class Pair
{
public:
    Pair() noexcept = default;
    Pair(const PairParts& parts, const PairMemory& memory,
         std::size_t index) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] const PairParts& parts() const noexcept { return parts_; }
    [[nodiscard]] std::uint32_t tool() const noexcept { return parts_.tool_index; }
    [[nodiscard]] std::uint32_t object() const noexcept { return parts_.object_number; }

    /// Fits the pair to where tool and object are in this frame.
    void place(const Budgets& budgets) noexcept TACTUS_NONBLOCKING;
    /// As place() found it.
    [[nodiscard]] const Urgency& urgency() const noexcept { return urgency_; }

    /// From now on nothing is loaded or refined for the pair, or something again.
    void shed(bool is_shed) noexcept { is_shed_ = is_shed; }
    /// Whether it has something to give up.
    [[nodiscard]] bool is_awake() const noexcept { return !outlook_.is_asleep(); }
    [[nodiscard]] bool is_of_mesh() const noexcept { return mesh_ != nullptr; }
    /// MeshPair::exchange_front(), of a tool that is a mesh.
    PairFront* exchange_front(PairFront* front) noexcept TACTUS_NONBLOCKING
    {
        TACTUS_ASSERT(mesh_ != nullptr);
        return mesh_->exchange_front(front);
    }

    /// Adds what the pair may touch soon to the ranking, unless its models are here as a whole.
    void rank(RegionRanking& ranking) noexcept TACTUS_NONBLOCKING;
    /// And, behind what all pairs may touch, what its distance needs (ToolSpec::wants_distance).
    void rank_distance(RegionRanking& ranking) const noexcept TACTUS_NONBLOCKING;

    /// Adds what the pair asks of its models: where the tool is and, coming nearer, where it will
    /// be. Certificates of questions that it does not ask are forgotten: a model may coarsen there.
    void ask(RefineRequests& requests) noexcept TACTUS_NONBLOCKING;

    /// After ask(): whether there is too much of the surface in reach, which merges help against;
    [[nodiscard]] bool is_short() const noexcept
    {
        return room_ == SurfaceTolerance::Room::short_ && tolerance_.code() != 0;
    }
    /// and whether it is of a model that is, or will be, here as a whole.
    [[nodiscard]] bool needs_coarser_model() const noexcept TACTUS_NONBLOCKING;

    /// The distance, and what the tool's force needs of the surface: triangles are kept where the
    /// room begins. Returns the room that is left.
    [[nodiscard]] SurfaceRoom query(const SurfaceRoom& room, const Budgets& budgets,
                                    WorkCounters& work,
                                    FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    /// Once more in the same frame, from where the tool has come to; nothing is refined between. A
    /// proxy's triangles need a room of their own: what it had before, or the one given. Returns
    /// what is left of that.
    [[nodiscard]] SurfaceRoom query_again(const SurfaceRoom& room, const Budgets& budgets,
                                          WorkCounters& work,
                                          FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    /// The last frame's query again, over what it kept; see Frame::rehearse().
    void rehearse(const SurfaceRoom& room, const Budgets& budgets,
                  WorkBudget& work) const noexcept TACTUS_NONBLOCKING;

    /// Whether, in this frame, the object's model isn't resident and its box is in the tool's
    /// reach: the tool stops there.
    [[nodiscard]] bool is_wall() const noexcept
    {
        return !is_model_here_ && lower_m_ <= parts_.tool->stance().reach_m;
    }

    /// Whether the object's model may go though the pair is of it: no touch is near, and the tool
    /// has nothing of its box in reach.
    [[nodiscard]] bool can_spare_model() const noexcept TACTUS_NONBLOCKING;
    /// It goes in this frame, and what was open in it has been released: the pair answers from the
    /// box.
    void lose_model() noexcept TACTUS_NONBLOCKING;

    /// Whether the tool's body knows of the object.
    [[nodiscard]] bool is_joined() const noexcept { return is_joined_; }
    /// What query() found, for the tool.
    [[nodiscard]] PlacedSurface placed() noexcept TACTUS_NONBLOCKING;
    /// Whether the object has come or moved in this frame.
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
    /// The same of one that stands still.
    void stand() noexcept
    {
        body_.velocity_m_per_s = Vec3(0.0, 0.0, 0.0);
        body_.spin_rad_per_s = Vec3(0.0, 0.0, 0.0);
    }
    /// Where a tool stands as in the last frame, query() would find what it found then.
    [[nodiscard]] bool is_unchanged() const noexcept TACTUS_NONBLOCKING;
    /// The frame ends: where the object stands is where it stood.
    void remember() noexcept
    {
        if (has_moved())
        {
            stood_ = parts_.object->pose;
        }
    }
    /// What is open in its models must be released before the pair ends.
    [[nodiscard]] Closure& object_closure() noexcept { return of_object_.closure; }
    [[nodiscard]] Closure& tool_closure() noexcept { return of_tool_.closure; }
    /// What query() found, for the caller of the frame.
    [[nodiscard]] PairOutput output() const noexcept TACTUS_NONBLOCKING;

private:
    /// What the pair asks of one of its models.
    template <std::size_t Capacity>
    struct Inquiry
    {
        StaticVector<RefineQuestion, Capacity> questions;
        Closure closure;
    };

    [[nodiscard]] std::uint32_t revision() const noexcept;
    void look() noexcept;
    void find_urgency() noexcept;
    [[nodiscard]] PairMotion motion() const noexcept;
    void fit_tolerance() noexcept;
    [[nodiscard]] SurfaceTolerance::Range tolerance_range() const noexcept;
    [[nodiscard]] SurfaceTolerance::Room surface_room() const noexcept;
    void ask_for_balls() noexcept;
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
    /// Of the tool's core from the model's box, of its frame: nearest and farthest.
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
    LocalSurface surface_;             ///< In the frame's room, for this frame.
    ContactReport* contacts_{nullptr}; ///< Null unless the tool wants them or is a mesh.
    TouchReport* touches_{nullptr};    ///< Null unless the tool is held as a body.
    MeshPair* mesh_{nullptr};          ///< Null unless the tool is a mesh.
    Outlook outlook_;
    Similarity asked_;           ///< Where the tool was when it was asked about last, in the world.
    Vec3 hand_m_{0.0, 0.0, 0.0}; ///< In the model's frame, in the last frame.
    Urgency urgency_;
    bool is_shed_{false};
    bool is_joined_{true};
    bool is_model_here_{true}; ///< In this frame.
    ObjectPose stood_;         ///< The object's, in the last frame.
    ProxyMemory body_;
    MaterialGlide feel_;
    bool feels_otherwise_{false}; ///< Than in the last frame.
    SurfaceTolerance tolerance_;
    SurfaceTolerance::Room room_{SurfaceTolerance::Room::fitting}; ///< In the last frame.
    bool had_work_left_{true};           ///< After it for half as much again as the frame had done.
    bool was_answered_{false};           ///< By the last query, and within its budgets.
    std::uint32_t answered_revision_{0}; ///< Of its models, at that time.
    RegionPredictor predictor_;
    std::array<RefineMemory, kPairQuestions> refine_memories_{};
    Inquiry<kPairQuestions> of_object_;
    Inquiry<MeshPair::kPlaces> of_tool_; ///< Of a tool that is a mesh.
    QueryMemory query_memory_;
    /// The answer's bounds in the world, wider by what the way there may round.
    double lower_m_{0.0};
    double upper_m_{0.0};
};

} // namespace tactus
