// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/mesh_pair.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/frame/model.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/rounding.hpp"
#include "rt_core/predict/region_predictor.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

/// Least distance from the other surface within which faces are exact, as a share of the tool's
/// size: surfaces that slide along each other part and meet in every frame.
constexpr double kLeastReach = 0.002;
/// Number of frames of tool motion that refinement covers beyond the reach; along a surface it
/// covers the whole approach instead, by at most the reach. While the motion is within this range,
/// certificates hold without a search.
constexpr double kFramesAhead = 4.0;
/// Least share of the reach beyond the radius within which contacts are searched. With less, a tool
/// would run into unknown surface beside it.
constexpr double kLeastOfReach = 0.25;
/// Least number of frames between two covers for prefetching. A cover is renewed if the tool has
/// moved by kCoverMoved of the cover's distance, or if that distance has grown or shrunk below
/// kCoverShrunk.
constexpr std::uint32_t kCoverFrames = 8;
constexpr double kCoverMoved = 0.1;
constexpr double kCoverShrunk = 0.8;
/// Prefetch distance beyond the reach, as a multiple of RegionOfInterest::approach_m().
constexpr double kPrefetchAhead = 4.0;

WalkBudget budget_of(const Budgets& budgets, WorkBudget& frame, std::uint32_t factor,
                     std::uint32_t parts = 1) noexcept
{
    WalkBudget budget{(factor * budgets.nodes + parts - 1) / parts,
                      (factor * budgets.triangles + parts - 1) / parts};
    budget.frame = &frame;
    return budget;
}

/// Collects the spheres of a cover. If there are too many, one grows to hold the new sphere.
class Cover
{
public:
    void add(const Sphere& sphere) noexcept
    {
        if (spheres_.size() < kMaxCoverSpheres)
        {
            spheres_.push_back(sphere);
            return;
        }
        Sphere* best = spheres_.begin();
        for (Sphere& other : spheres_)
        {
            best = growth(other, sphere) < growth(*best, sphere) ? &other : best;
        }
        best->radius += std::max(growth(*best, sphere), 0.0);
    }
    [[nodiscard]] const CoreCover& spheres() const noexcept { return spheres_; }

private:
    /// Growth of the radius of `grown` if it is to hold `added`; negative if it does already.
    [[nodiscard]] static double growth(const Sphere& grown, const Sphere& added) noexcept
    {
        return (grown.center - added.center).norm() + added.radius - grown.radius;
    }

    CoreCover spheres_;
};

/// Spheres, in a model's frame, that hold all of its faces within `near_m` of another surface.
CoreCover cover_near(const AbTree& tree, OtherSurface& other, double near_m) noexcept
{
    Cover cover;
    SurfaceWalk walk(tree, other);
    while (walk.next_block(near_m) != kNoNode)
    {
        cover.add(walk.sphere());
    }
    for (const SurfaceWalk::Item& item : walk.left())
    {
        cover.add(item.sphere);
    }
    return cover.spheres();
}

} // namespace

void MeshPair::place(const RegionOfInterest& region_of_interest, const MeshCore& core,
                     const Model& tool_model, const Model& object_model, const Similarity& tool,
                     const Budgets& budgets, WorkBudget& frame) noexcept
{
    tool_model_ = &tool_model;
    object_model_ = &object_model;
    moved_on_m_ = 0.0;
    own_sphere_ = {0.5 * core.extent_m, 0.5 * core.extent_m.norm() * kRoundedUp};
    for (std::size_t i = 0; i < kPlaces; ++i)
    {
        Similarity placed = tool;
        placed.translation_m += static_cast<double>(i) * region_of_interest.approach_m();
        placements_[i] = {placed, core.origin_m};
        const PlacedCore now(core, placed);
        moved_m_[i] = now.motion_since(cores_[i]);
        cores_[i] = now;
    }
    fit_searches();
    cover_moved_m_ += moved_m_[0];
    asks_otherwise_ = asks_about_meeting_ != is_meeting_;
    asks_about_meeting_ = is_meeting_;
    see_surfaces(budgets, frame);
}

/// Only the first place moves. The cores stay, as the motion since the last frame is measured from
/// them.
void MeshPair::move(const Similarity& tool, const Budgets& budgets, WorkBudget& frame) noexcept
{
    const MeshPlacement before = placements_[0];
    placements_[0].place = tool;
    moved_on_m_ += motion_between(before, placements_[0], own_sphere_);
    note_use();
    see_surfaces(budgets, frame);
}

/// Adapts the allowance of refining searches to its use in the last frame.
void MeshPair::fit_searches() noexcept
{
    note_use();
    if (were_cut_short_)
    {
        search_parts_ = std::max(search_parts_ / kSearchGrowth, 1U);
    }
    else if (were_far_from_cut_)
    {
        search_parts_ = std::min(2 * search_parts_, kSearchParts);
    }
    were_cut_short_ = false;
    were_far_from_cut_ = true;
}

void MeshPair::note_use() noexcept
{
    for (auto* surfaces : {&objects_, &tools_})
    {
        for (OtherSurface& surface : *surfaces)
        {
            const WalkBudget& budget = surface.budget();
            were_cut_short_ = were_cut_short_ || budget.is_spent;
            were_far_from_cut_ = were_far_from_cut_ &&
                                 kSearchGrowth * budget.nodes_visited <= budget.nodes &&
                                 kSearchGrowth * budget.triangles_tested <= budget.triangles;
        }
    }
}

/// Sets up the surfaces for this frame's searches, each with a whole allowance.
void MeshPair::see_surfaces(const Budgets& budgets, WorkBudget& frame) noexcept
{
    TACTUS_ASSERT(tool_model_ != nullptr); // place() comes before move().
    TACTUS_ASSERT(object_model_ != nullptr);
    const WalkBudget to_refine = budget_of(budgets, frame, kMeshRefineFactor, search_parts_);
    for (std::size_t i = 0; i < kPlaces; ++i)
    {
        objects_[i] = OtherSurface(object_model_->tree, placements_[i], to_refine);
        tools_[i] = OtherSurface(tool_model_->tree, placements_[i].inverse(), to_refine);
    }
    covered_ = OtherSurface(object_model_->tree, placements_[0], budget_of(budgets, frame, 1));
    queried_ = OtherSurface(object_model_->tree, placements_[0],
                            budget_of(budgets, frame, kMeshBudgetFactor));
}

void MeshPair::rank(const RegionOfInterest& region_of_interest, ModelId tool_model,
                    ModelId object_model, const RegionPredictor& predictor, Prediction prediction,
                    RegionRanking& ranking) noexcept
{
    const double scale = placements_[0].place.scale;
    const double reach_m = RegionOfInterest::kKeepFactor * refine_reach_m(region_of_interest);
    const double near_m = reach_m + kPrefetchAhead * region_of_interest.approach_m().norm();
    find_cover(near_m);
    CoreCover of_object;
    for (const Sphere& sphere : cover_)
    {
        of_object.push_back({placements_[0].local_to_world(sphere.center), scale * sphere.radius});
    }
    predictor.rank(prediction, object_model, of_object, reach_m, ranking);
    RegionPredictor::rank_present(tool_model, cover_, reach_m / scale, ranking);
}

void MeshPair::find_cover(double near_m) noexcept
{
    const bool is_other = near_m > cover_near_m_ || near_m < kCoverShrunk * cover_near_m_;
    if (frames_until_cover_ == 0 && (is_other || cover_moved_m_ > kCoverMoved * near_m))
    {
        cover_near_m_ = (1.0 + kCoverMoved) * near_m;
        cover_ =
            cover_near(tool_model_->tree, covered_, cover_near_m_ / placements_[0].place.scale);
        cover_moved_m_ = 0.0;
        frames_until_cover_ = kCoverFrames;
    }
    frames_until_cover_ -= frames_until_cover_ > 0 ? 1U : 0U;
}

double MeshPair::refine_reach_m(const RegionOfInterest& region_of_interest) noexcept
{
    return std::max(region_of_interest.reach_m(), kLeastReach * region_of_interest.core().radius());
}

bool MeshPair::goes_along(const RegionOfInterest& region_of_interest) noexcept
{
    return region_of_interest.is_near_surface() &&
           region_of_interest.approach_m().norm() <= refine_reach_m(region_of_interest);
}

double MeshPair::ahead_m(std::size_t place,
                         const RegionOfInterest& region_of_interest) const noexcept
{
    const double way_m =
        goes_along(region_of_interest) ? region_of_interest.approach_m().norm() : 0.0;
    return std::min(std::max(kFramesAhead * moved_m_[place], way_m),
                    refine_reach_m(region_of_interest));
}

/// Question about the place where two faces meet, with its surroundings for a few frames of motion.
/// Exact faces in the tool's sphere stay exact. `scale` converts lengths of the question's frame to
/// the object's.
RefineQuestion MeshPair::about_meeting(const Vec3& center_m, double radius_m, double scale,
                                       RefineMemory& memory) const noexcept
{
    const double reach_m = kLeastReach * radius_m + kFramesAhead * moved_m_[0] / scale;
    return {center_m, reach_m, 2.0 * radius_m + reach_m, &memory};
}

RefineQuestion MeshPair::ask_object(std::size_t place, const RegionOfInterest& region_of_interest,
                                    RefineMemory& memory) noexcept
{
    memory.is_known = memory.is_known && !asks_otherwise_;
    if (asks_about_meeting_)
    {
        return about_meeting(meeting_m_, cores_[0].radius(), 1.0, memory);
    }
    return question({cores_[place].center(), cores_[place].radius()},
                    refine_reach_m(region_of_interest), moved_m_[place],
                    ahead_m(place, region_of_interest), tools_[place], memory,
                    place == 0 ? &of_object_ : nullptr);
}

RefineQuestion MeshPair::ask_tool(std::size_t place,
                                  const RegionOfInterest& region_of_interest) noexcept
{
    const double scale = placements_[place].place.scale;
    RefineMemory& memory = tool_memories_[place];
    memory.is_known = memory.is_known && !asks_otherwise_;
    if (asks_about_meeting_)
    {
        const Vec3 meeting_m = placements_[0].inverse().local_to_world(meeting_m_);
        return about_meeting(meeting_m, own_sphere_.radius, scale, memory);
    }
    return question(own_sphere_, refine_reach_m(region_of_interest) / scale,
                    moved_m_[place] / scale, ahead_m(place, region_of_interest) / scale,
                    objects_[place], memory, place == 0 ? &of_tool_ : nullptr);
}

/// Question about the faces of a sphere that are within `reach_m` of another surface, in the
/// sphere's frame.
RefineQuestion MeshPair::question(const Sphere& sphere, double reach_m, double moved_m,
                                  double ahead_m, OtherSurface& surface, RefineMemory& memory,
                                  UnfinishedSearch* unfinished) noexcept
{
    return {.center_m = sphere.center,
            .reach_m = sphere.radius + reach_m,
            .keep_m = sphere.radius + RegionOfInterest::kKeepFactor * (reach_m + ahead_m),
            .memory = &memory,
            .surface = &surface,
            .span_m = sphere.radius,
            .moved_m = moved_m,
            .ahead_m = ahead_m,
            .unfinished = unfinished};
}

double MeshPair::certified_m(const RefineMemory& of_object) const noexcept
{
    if (asks_about_meeting_)
    {
        return 0.0;
    }
    const auto beyond_m = [](const Model& model, const RefineMemory& memory, double span_m)
    {
        return model.is_complete() ? kInfinity
               : memory.is_known   ? memory.certified_m / kRoundedUp - span_m * kRoundedUp
                                   : 0.0;
    };
    const double object_m = beyond_m(*object_model_, of_object, cores_[0].radius());
    const double tool_m = beyond_m(*tool_model_, tool_memories_[0], own_sphere_.radius);
    const double near_m = std::min(object_m, tool_m * placements_[0].place.scale / kRoundedUp);
    return std::max(0.0, near_m / kRoundedUp - moved_on_m_ * kRoundedUp);
}

double MeshPair::touch_m(double radius_m, double reach_m) const noexcept
{
    const double share = std::max(memory_.share / static_cast<double>(kProofShare), kLeastOfReach);
    return share < 1.0 ? radius_m + share * (reach_m - radius_m) : reach_m;
}

ErrorCode MeshPair::tool_tolerance(ErrorCode tolerance) const noexcept
{
    TACTUS_ASSERT(object_model_ != nullptr);
    const double error_m = static_cast<double>(error_in_quanta(tolerance)) *
                           static_cast<double>(object_model_->header.quantum_m());
    const double quantum_m =
        static_cast<double>(tool_model_->header.quantum_m()) * placements_[0].place.scale;
    return largest_code_within(error_m / quantum_m);
}

void MeshPair::query(const RegionOfInterest& region_of_interest, double certified_m,
                     double contact_m, std::uint32_t enough, ErrorCode tolerance, ContactEnds* ends,
                     DistanceAnswer& answer, ContactReport& contacts) noexcept
{
    TACTUS_ASSERT(enough > 0);
    const MeshQuestion question{tool_model_->tree,
                                object_model_->tree,
                                placements_[0],
                                region_of_interest.reach_m(),
                                contact_m,
                                ends,
                                certified_m,
                                enough,
                                front_,
                                tool_tolerance(tolerance),
                                tolerance};
    query_meshes(question, queried_, memory_, answer, report_, contacts);
    if (answer.nearest_face.is_none())
    {
        answer.tool_point_m = region_of_interest.core().center();
    }
    const bool do_meet = report_.intersection == Intersection::proven ||
                         report_.intersection == Intersection::within_tolerance;
    is_meeting_ = enough == 1 && do_meet && !answer.nearest_face.is_none();
    meeting_m_ = answer.nearest_point_m;
}

void MeshPair::forget_refinement() noexcept
{
    for (RefineMemory& memory : tool_memories_)
    {
        memory.is_known = false;
    }
}

void MeshPair::note_lower(double lower_m) noexcept
{
    if (lower_m > 0.0)
    {
        TACTUS_ASSERT(report_.meeting.empty());
        report_.intersection = Intersection::none;
        report_.is_complete = true;
    }
}

void MeshPair::rest(ContactReport& contacts) noexcept
{
    is_meeting_ = false;
    report_.clear();
    report_.intersection = Intersection::none;
    report_.is_complete = true;
    contacts.clear();
    contacts.is_complete = true;
}

/// Adds the work of all surfaces' searches. A cut search for the cover is no fault: the cover's
/// spheres are only larger.
void MeshPair::add_work(WorkCounters& work, FrameFault& faults) noexcept
{
    const auto add = [&](OtherSurface& surface, bool lacks_some)
    {
        const WalkBudget& budget = surface.budget();
        work.nodes_visited += budget.nodes_visited;
        work.triangles_tested += budget.triangles_tested;
        faults |= budget.is_spent && lacks_some ? FrameFault::node_budget_spent : FrameFault::none;
    };
    add(queried_, true);
    add(covered_, false);
    for (std::size_t i = 0; i < kPlaces; ++i)
    {
        add(objects_[i], true);
        add(tools_[i], true);
    }
}

} // namespace tactus
