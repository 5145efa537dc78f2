// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/pair.hpp"

#include "rt_core/frame/model.hpp"
#include "rt_core/query/contact_report.hpp"
#include "rt_core/query/contact_set.hpp"
#include "rt_core/query/core_query.hpp"
#include "rt_core/query/probe.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

/// Transforms contacts from the model's frame to the world.
void place_each_in_world(const ObjectPose& pose, auto& contacts) noexcept
{
    for (Contact& contact : contacts)
    {
        contact.distance_m *= pose.scale;
        contact.on_tool_m = to_world(pose, contact.on_tool_m);
        contact.on_surface_m = to_world(pose, contact.on_surface_m);
        contact.normal = pose.rotation * contact.normal;
    }
}

void place_in_world(const ObjectPose& pose, ContactReport& report) noexcept
{
    report.normal = pose.rotation * report.normal;
    place_each_in_world(pose, report.contacts);
}

void place_in_world(const ObjectPose& pose, TouchReport& touches) noexcept
{
    place_each_in_world(pose, touches.nearest);
    place_each_in_world(pose, touches.corners);
    if (!touches.ends.is_empty)
    {
        place_each_in_world(pose, touches.ends.contacts);
    }
    for (ContactSlab& slab : touches.slabs)
    {
        slab.distance_m *= pose.scale;
        slab.normal = pose.rotation * slab.normal;
    }
    touches.covered_m *= pose.scale;
}

/// Drops contacts beyond the radius, from a search within a larger distance.
void keep_within(double radius_m, const DistanceAnswer& answer, ContactReport& report) noexcept
{
    ContactSet& contacts = report.contacts;
    const bool has_seen_all = report.is_complete || !contacts.full();
    bool has_left_out = false;
    while (!contacts.empty() && contacts[contacts.size() - 1].distance_m > radius_m)
    {
        (void)contacts.pop_back();
        has_left_out = true;
    }
    report.is_complete = (has_seen_all || has_left_out) &&
                         (answer.certified_radius_m >= radius_m || answer.lower_m > radius_m);
}

/// Largest error of coarse faces that count as the surface, in quanta; holds for any stiffness.
constexpr double kToleratedQuanta = 0.25;
/// Largest such error if capacity is short, as a share of the tool's radius, so that the tool stays
/// outside.
constexpr double kMostTolerated = 0.5;

/// Faults of refinement that a coarser surface avoids: memory is full, or work is late.
constexpr FrameFault kSurfaceFull = FrameFault::forest_full | FrameFault::tree_full |
                                    FrameFault::cache_full | FrameFault::refine_heap_full |
                                    FrameFault::held_records_full;
constexpr FrameFault kSurfaceLate = FrameFault::split_budget_spent | FrameFault::node_budget_spent;

/// Share of the approach by which a search ahead goes farther, so that one search serves about two
/// frames.
constexpr double kWalkedShare = 0.2;

/// Factor that covers the rounding of the distance to a box: more than four roundings.
constexpr double kBoxRoundedDown = 1.0 - 0x1p-49;

const MeshCore& mesh_core_of(const Tool& tool) noexcept
{
    const auto* core = std::get_if<MeshCore>(&tool.spec().core);
    TACTUS_ASSERT(core != nullptr);
    return *core;
}

bool wants_contacts(const ToolSpec& tool) noexcept
{
    return tool.wants_contacts || is_mesh(tool);
}

} // namespace

PairMemory PairMemory::take(Arena& arena, std::span<const ToolSpec> tools,
                            std::size_t pairs) noexcept
{
    const auto for_any = [&](bool (*needs)(const ToolSpec&) noexcept)
    { return std::ranges::any_of(tools, needs) ? pairs : 0; };
    return {arena.take<ContactReport>(for_any(&wants_contacts)),
            arena.take<TouchReport>(for_any(&Tool::is_held_as_rigid)),
            arena.take<MeshPair>(for_any(&is_mesh)),
            arena.take<PairFront>(std::min<std::size_t>(for_any(&is_mesh), PairFront::kFronts))};
}

Pair::Pair(const PairParts& parts, const PairMemory& memory, std::size_t index) noexcept
    : parts_(parts)
    , is_joined_(!parts.begins_apart)
    , last_pose_(parts.object->pose)
    , material_(parts.object->spec.material)
{
    TACTUS_ASSERT(parts.rules != nullptr);
    TACTUS_ASSERT(parts.model.model != nullptr);
    const ToolSpec& tool = parts.tool->spec();
    TACTUS_ASSERT(is_mesh(tool) == (parts.tool_model.model != nullptr));
    contacts_ = wants_contacts(tool) ? &memory.contacts[index] : nullptr;
    touches_ = Tool::is_held_as_rigid(tool) ? &memory.touches[index] : nullptr;
    mesh_ = is_mesh(tool) ? &memory.meshes[index] : nullptr;
    if (mesh_ != nullptr)
    {
        *mesh_ = MeshPair{};
    }
}

void Pair::place(const Budgets& budgets) noexcept
{
    TACTUS_ASSERT(parts_.rules->work != nullptr);
    const ToolPlacement& placement = parts_.tool->placement();
    is_model_here_ = parts_.model.model->is_resident();
    has_material_changed_ =
        material_.step(parts_.object->spec.material, parts_.tool->spec().stiffness_n_per_m,
                       static_cast<double>(parts_.rules->period_ns) * 1e-9);
    update_region();
    find_priority();
    if (mesh_ != nullptr && is_model_here_)
    {
        mesh_->place(region_of_interest_, mesh_core_of(*parts_.tool), *parts_.tool_model.model,
                     *parts_.model.model, in_frame(parts_.object->pose, placement.place), budgets,
                     *parts_.rules->work);
    }
}

void Pair::update_region() noexcept
{
    region_of_interest_.update(parts_.tool->spec(), parts_.tool->placement(), parts_.object->pose);
    if (!parts_.rules->variant.lets_pairs_rest || tells_distance())
    {
        region_of_interest_.wake();
    }
}

void Pair::find_priority() noexcept
{
    const Tool& tool = *parts_.tool;
    const ObjectPose& pose = parts_.object->pose;
    const Vec3 before_m = device_m_;
    device_m_ = to_model(pose, tool.goal().position_m);
    priority_ = Priority::at(0.0, 0.0, tool.spec().query_only);
    if (region_of_interest_.has_known())
    {
        const double gap_m =
            region_of_interest_.from_motion().lower_m * pose.scale - tool.radius_m();
        const double speed = (device_m_ - before_m).norm() * pose.scale / tool.goal().elapsed_s;
        priority_ = Priority::at(std::max(gap_m, 0.0), speed, tool.spec().query_only);
    }
}

/// Motion of the tool relative to the object, for the predictor.
PairMotion Pair::motion() const noexcept
{
    const Tool& tool = *parts_.tool;
    const ObjectPose& pose = parts_.object->pose;
    PairMotion motion;
    motion.center_m = region_of_interest_.core().center();
    motion.way_m = to_model(pose, tool.goal().position_m) -
                   to_model(pose, tool.placement().place.translation_m);
    motion.speed_max_m_per_s = tool.spec().speed_max_m_per_s / pose.scale;
    motion.elapsed_s = tool.goal().elapsed_s;
    if (region_of_interest_.has_known() && !region_of_interest_.known().nearest_face.is_none())
    {
        const Vec3 apart =
            region_of_interest_.known().tool_point_m - region_of_interest_.known().nearest_point_m;
        const double distance = apart.norm();
        if (distance > 0.0)
        {
            motion.outward = apart / distance;
            motion.gap_m = std::max(distance - tool.radius_m() / pose.scale, 0.0);
        }
    }
    return motion;
}

void Pair::rank(RegionRanking& ranking) noexcept
{
    if (is_shed_ || !is_model_here_)
    {
        return;
    }
    if (parts_.model.model->is_complete() &&
        (parts_.tool_model.model == nullptr || parts_.tool_model.model->is_complete()))
    {
        return;
    }
    const PairRules& rules = *parts_.rules;
    const std::size_t before = ranking.size();
    predictor_.observe(motion(), parts_.model.model->horizon_s(rules.period_ns));
    if (mesh_ != nullptr)
    {
        mesh_->rank(region_of_interest_, parts_.tool_model.id, parts_.model.id, predictor_,
                    rules.prediction, ranking);
    }
    else if (rules.variant.asks_ahead && !measures_from_afar())
    {
        predictor_.rank(rules.prediction, parts_.model.id, region_of_interest_.cover(),
                        region_of_interest_.reach_m(), ranking);
    }
    else
    {
        RegionPredictor::rank_present(parts_.model.id, region_of_interest_.cover(),
                                      region_of_interest_.reach_m(), ranking);
    }
    for (std::size_t i = before; i < ranking.size(); ++i)
    {
        ranking[i].of = priority_.of;
    }
}

/// Radius round the core's centre within which the nearest surface may lie, if that is beyond the
/// reach. 0 if the distance is not requested or nothing is known. Without an upper bound, as where
/// edits have changed all coarse faces that are near, it is twice the lower bound: each time that
/// all within it is exact, the bounds close or the lower one has doubled.
double Pair::distance_reach_m() const noexcept
{
    if (!tells_distance() || !region_of_interest_.has_known())
    {
        return 0.0;
    }
    const DistanceAnswer known = region_of_interest_.from_motion();
    const double nearest_m = known.upper_m < kInfinity ? known.upper_m : 2.0 * known.lower_m;
    return nearest_m > region_of_interest_.reach_m()
               ? region_of_interest_.core().radius() + nearest_m
               : 0.0;
}

/// True if the pair needs surface for its distance alone. No region ahead is then ranked, as the
/// ranking could not hold those of many such pairs.
bool Pair::measures_from_afar() const noexcept
{
    return parts_.tool->spec().query_only && distance_reach_m() > 0.0;
}

/// A region that does not fit is ranked in a later frame.
void Pair::rank_distance(RegionRanking& ranking) const noexcept
{
    const double reach_m = distance_reach_m();
    if (reach_m > 0.0 && !is_shed_ && is_model_here_ && !parts_.model.model->is_complete())
    {
        (void)ranking.try_push_back({parts_.model.id, region_of_interest_.core().center(), reach_m,
                                     0, PriorityClass::last});
    }
}

void Pair::ask(RefineRequests& requests) noexcept
{
    of_object_.questions.clear();
    of_tool_.questions.clear();
    if (!is_model_here_)
    {
        // There is nothing to ask: nothing was requested yet, or lose_model() has dropped the
        // state.
        return;
    }
    fit_tolerance();
    if (mesh_ != nullptr)
    {
        ask_for_mesh();
        request(parts_.tool_model, of_tool_, requests);
    }
    else
    {
        ask_for_spheres();
    }
    request(parts_.model, of_object_, requests);
}

void Pair::fit_tolerance() noexcept
{
    room_ = surface_room();
    tolerance_.fit(tolerance_range(), room_, late_for() == FrameFault::none);
    of_object_.tolerance = tolerance_.code();
    of_tool_.tolerance = mesh_ != nullptr ? mesh_->tool_tolerance(tolerance_.code()) : 0;
}

bool Pair::needs_coarser_model() const noexcept
{
    return is_model_here_ && parts_.model.model->is_whole() &&
           tolerance_.code() > tolerance_range().least;
}

SurfaceTolerance::Range Pair::tolerance_range() const noexcept
{
    const PairRules& rules = *parts_.rules;
    const double quanta_of_m = 1.0 / static_cast<double>(parts_.model.model->header.quantum_m());
    if (rules.variant.tolerance_m > 0.0)
    {
        const ErrorCode fixed = largest_code_within(rules.variant.tolerance_m * quanta_of_m);
        return {fixed, fixed};
    }
    if (rules.force_tolerance_n == 0.0 || parts_.tool->spec().wants_pairs)
    {
        return {}; // Only exact faces decide which faces meet.
    }
    const double surfaces = mesh_ != nullptr ? 2.0 : 1.0; // The errors of both meshes add up.
    const double stiffness =
        std::min(parts_.tool->spec().stiffness_n_per_m, material_.felt().stiffness_n_per_m);
    const double imperceptible_m = rules.force_tolerance_n / stiffness / parts_.object->pose.scale;
    const double most_m = kMostTolerated * parts_.tool->radius_m() / parts_.object->pose.scale;
    const ErrorCode most = largest_code_within(most_m * quanta_of_m / surfaces);
    const ErrorCode least =
        largest_code_within(std::min(kToleratedQuanta, imperceptible_m * quanta_of_m / surfaces));
    return {std::min(least, most), most};
}

/// Finds from the last frame whether capacity and time suffice for the surface.
SurfaceTolerance::Room Pair::surface_room() const noexcept
{
    if (surface_.is_cut || has_fault(late_for(), kSurfaceFull))
    {
        return SurfaceTolerance::Room::short_;
    }
    if (has_fault(late_for(), kSurfaceLate) || (mesh_ != nullptr && !was_answered_))
    {
        const DistanceAnswer& answer = surface_.answer;
        const bool is_unknown = mesh_ != nullptr && answer.kind == AnswerKind::bounded &&
                                answer.lower_m <= region_of_interest_.reach_m();
        return is_unknown ? SurfaceTolerance::Room::unknown : SurfaceTolerance::Room::late;
    }
    return would_finer_fit() ? SurfaceTolerance::Room::enough : SurfaceTolerance::Room::fitting;
}

/// True if some surface is in reach, and a finer one would fit into memory and budgets.
bool Pair::would_finer_fit() const noexcept
{
    constexpr double kGrowth = SurfaceTolerance::kFinerGrowth;
    const VertexForest& forest = parts_.model.model->forest;
    const bool has_surface =
        mesh_ != nullptr ? region_of_interest_.has_known() &&
                               region_of_interest_.known().lower_m <= region_of_interest_.reach_m()
                         : surface_.count > 0;
    return has_surface && had_work_left_ && surface_.count * kGrowth < kMaxLocalTriangles &&
           forest.active_in_pool() * kGrowth < forest.capacity();
}

void Pair::note_work_left(const WorkBudget& budget) noexcept
{
    had_work_left_ = (SurfaceTolerance::kFinerGrowth - 1.0) * budget.used() <=
                     static_cast<double>(budget.left());
}

/// Asks about the spheres of the region of interest. Certificates of unused spheres are dropped.
void Pair::ask_for_spheres() noexcept
{
    const double fixed_radius = parts_.rules->variant.fixed_radius;
    const Model& model = *parts_.model.model;
    const bool looks_ahead = region_of_interest_.looks_ahead() && !model.is_complete();
    auto* memory = refine_memories_.data();
    for (const Sphere& here : region_of_interest_.cover())
    {
        const double reach_m = (here.radius + region_of_interest_.reach_m()) *
                               (fixed_radius > 0.0 ? fixed_radius : 1.0);
        RefineQuestion question{here.center, reach_m, RegionOfInterest::kKeepFactor * reach_m,
                                memory++};
        ask(!region_of_interest_.is_asleep(), model, question, of_object_);
        question.memory = memory++;
        ask(looks_ahead, model, looks_ahead ? ahead_of(question) : question, of_object_);
    }
    TACTUS_ASSERT(memory <= &refine_memories_.back()); // A cover has at most kMaxCoverSpheres.
    for (const auto* const end = &refine_memories_.back(); memory != end; ++memory)
    {
        memory->is_known = false;
    }
    if (tells_distance())
    {
        ask_for_distance();
    }
}

/// Asks for all surface that may be nearer than the nearest known point; the question may wait. The
/// range in which faces stay refined is hardly larger, or a distant tool would keep all that it
/// passed.
void Pair::ask_for_distance() noexcept
{
    RefineQuestion question{region_of_interest_.core().center(), distance_reach_m(), 0.0,
                            &refine_memories_.back()};
    question.later_m =
        question.reach_m - region_of_interest_.core().radius() - region_of_interest_.reach_m();
    question.keep_m =
        question.reach_m + (RegionOfInterest::kKeepFactor - 1.0) * region_of_interest_.reach_m();
    ask(question.reach_m > 0.0 && question.later_m > 0.0, *parts_.model.model, question,
        of_object_);
}

/// Moves a question to the tool's future place. Along a surface, the place is no farther than the
/// reach, the question may wait, and one search covers several frames.
RefineQuestion Pair::ahead_of(RefineQuestion question) const noexcept
{
    Vec3 way_m = region_of_interest_.approach_m();
    if (region_of_interest_.is_near_surface())
    {
        way_m *= std::min(1.0, question.reach_m / way_m.norm());
        question.later_m = way_m.norm();
        question.ahead_m = kWalkedShare * question.later_m;
        question.keep_m += question.ahead_m;
    }
    question.center_m += way_m;
    return question;
}

void Pair::ask_for_mesh() noexcept
{
    MeshPair& mesh = *mesh_;
    const bool may_meet =
        region_of_interest_.has_known() && !(region_of_interest_.known().lower_m > 0.0);
    for (std::size_t place = 0; place < MeshPair::kPlaces; ++place)
    {
        const bool is_asked = place == 0 ? !region_of_interest_.is_asleep()
                                         : region_of_interest_.looks_ahead() && !may_meet &&
                                               !MeshPair::goes_along(region_of_interest_);
        ask(is_asked, *parts_.model.model,
            mesh.ask_object(place, region_of_interest_, refine_memories_[place]), of_object_);
        ask(is_asked, *parts_.tool_model.model, mesh.ask_tool(place, region_of_interest_),
            of_tool_);
    }
}

template <std::size_t Capacity>
void Pair::ask(bool is_asked, const Model& model, const RefineQuestion& question,
               Inquiry<Capacity>& inquiry) const noexcept
{
    const FrameVariant& variant = parts_.rules->variant;
    if (!variant.keeps_certificates)
    {
        question.memory->is_known = false;
    }
    // Beyond the kernels' range no model is in reach; a complete model lacks nothing.
    if (is_asked && !is_shed_ && !model.is_complete() &&
        !is_beyond_kernels(question.center_m, model.header.quantum_m()))
    {
        RefineQuestion asked = question;
        asked.counts_errors = variant.fixed_radius == 0.0;
        asked.tolerance = inquiry.tolerance;
        inquiry.questions.push_back(asked);
        return;
    }
    question.memory->is_known = false;
}

/// Adds a request with the pair's questions to one model. Without questions a request is only made
/// if the closure is still open.
template <std::size_t Capacity>
void Pair::request(const NamedModel& model, Inquiry<Capacity>& inquiry,
                   RefineRequests& requests) const noexcept
{
    inquiry.closure.late_for = FrameFault::none;
    if (!inquiry.questions.empty() || !inquiry.closure.target.is_none())
    {
        requests.push_back({model.id, inquiry.questions.view(), &inquiry.closure, priority_});
    }
}

SurfaceRoom Pair::query(const SurfaceRoom& room, const Budgets& budgets, WorkCounters& work,
                        FrameFault& faults) noexcept
{
    LocalSurface& surface = surface_;
    surface = room.surface();
    const ObjectPose& pose = parts_.object->pose;
    asked_ = parts_.tool->placement().place;
    if (region_of_interest_.is_asleep())
    {
        surface.answer = region_of_interest_.from_motion();
        work.skipped.add(Skip::pairs);
    }
    FrameFault found = FrameFault::none;
    if (!is_model_here_)
    {
        query_box();
    }
    else if (mesh_ != nullptr)
    {
        query_mesh(work, found);
    }
    else
    {
        query_core(budgets, work, found);
    }
    if (age_ns(pose, parts_.rules->now_ns) > parts_.rules->pose_age_max_ns ||
        pose.revision != parts_.model.model->header.fields().revision)
    {
        surface.answer.kind = AnswerKind::stale;
    }
    const double rounding = rounding_m();
    lower_m_ = std::max(0.0, surface.answer.lower_m * pose.scale - rounding);
    upper_m_ = surface.answer.upper_m * pose.scale + rounding;
    if (std::exchange(may_be_entered_, false) && !(surface.answer.lower_m > 0.0))
    {
        is_joined_ = false;
    }
    is_joined_ = is_joined_ || lower_m_ > parts_.tool->radius_m();
    was_answered_ = found == FrameFault::none && is_model_here_;
    answered_revision_ = revision();
    faults |= found;
    return room.after(surface.count);
}

SurfaceRoom Pair::query_again(const SurfaceRoom& room, const Budgets& budgets, WorkCounters& work,
                              FrameFault& faults) noexcept
{
    const ToolPlacement& placement = parts_.tool->placement();
    const ObjectPose& pose = parts_.object->pose;
    update_region();
    if (mesh_ != nullptr && is_model_here_)
    {
        mesh_->move(in_frame(pose, placement.place), budgets, *parts_.rules->work);
    }
    if (touches_ != nullptr)
    {
        (void)query(room, budgets, work, faults);
        return room;
    }
    const SurfaceRoom own{surface_.triangles.first(surface_.count),
                          surface_.distances_m.first(surface_.count)};
    if (own.triangles.size() < room.triangles.size())
    {
        return query(room, budgets, work, faults);
    }
    (void)query(own, budgets, work, faults);
    return room;
}

/// Sum of the models' revisions; changes with each change of either, as revisions only grow.
std::uint32_t Pair::revision() const noexcept
{
    return parts_.model.model->revision +
           (mesh_ != nullptr ? parts_.tool_model.model->revision : 0U);
}

/// True if a query would give the same answer. A pose from a server counts as changing, as it may
/// become too old.
bool Pair::is_unchanged() const noexcept
{
    return was_answered_ && !has_moved() && !has_material_changed_ &&
           parts_.object->pose.arrival_ns == 0 && answered_revision_ == revision();
}

bool Pair::can_spare_model() const noexcept
{
    return mesh_ == nullptr && priority_.of >= PriorityClass::later &&
           gap_to_box().lower_m > region_of_interest_.reach_m();
}

void Pair::lose_model() noexcept
{
    TACTUS_ASSERT(mesh_ == nullptr);
    TACTUS_ASSERT(of_object_.closure.target.is_none());
    is_model_here_ = false;
    forget_refinement();
}

void Pair::forget_refinement() noexcept
{
    for (RefineMemory& memory : refine_memories_)
    {
        memory.is_known = false;
    }
    if (mesh_ != nullptr)
    {
        mesh_->forget_refinement();
    }
}

void Pair::invalidate() noexcept
{
    region_of_interest_.invalidate();
    forget_refinement();
}

void Pair::ignore_if_entered(const SurfaceEdit& edit) noexcept
{
    TACTUS_ASSERT(edit.model == model());
    const Tool& tool = *parts_.tool;
    if (!is_joined_ || !tool.is_held())
    {
        return;
    }
    const PlacedCore& core = region_of_interest_.core();
    const auto quantum_m = static_cast<double>(parts_.model.model->header.quantum_m());
    const double radius_m = tool.radius_m() / parts_.object->pose.scale;
    const double entered_m = std::max(radius_m * (1.0 - kTouchShare) - 2.0 * quantum_m, 0.0);
    const auto may_enter = [&](const Triangle& face)
    {
        const ClosestPoint closest = closest_point_on_triangle(core.center(), face);
        return std::sqrt(closest.distance_sq) <= core.radius() + entered_m;
    };
    const auto enters = [&](const AddedFace& added)
    {
        const Triangle face = to_triangle(added.corners_m);
        return may_enter(face) && core.closest(face).distance <= entered_m;
    };
    if (mesh_ != nullptr)
    {
        // Its query tells whether it meets the surface.
        may_be_entered_ = may_be_entered_ ||
                          std::ranges::any_of(edit.added, [&](const AddedFace& added)
                                              { return may_enter(to_triangle(added.corners_m)); });
    }
    else
    {
        is_joined_ = std::ranges::none_of(edit.added, enters);
    }
}

/// Bounds on the distance by the model's box: the surface lies in it and touches each of its sides.
Pair::BoxGap Pair::gap_to_box() const noexcept
{
    const ModelHeader& header = parts_.model.model->header;
    const auto quantum_m = static_cast<double>(header.quantum_m());
    const auto& extent = header.fields().extent_quanta;
    const Vec3 center_m = region_of_interest_.core().center();
    Vec3 outside_m(0.0, 0.0, 0.0);
    Vec3 farthest_m(0.0, 0.0, 0.0);
    for (int axis = 0; axis < 3; ++axis)
    {
        const double here_m = center_m[axis];
        const double high_m = quantum_m * extent[static_cast<std::size_t>(axis)];
        outside_m[axis] = std::max({0.0, -here_m, here_m - high_m});
        farthest_m[axis] = std::max(std::abs(here_m), std::abs(high_m - here_m));
    }
    return {std::max(0.0, outside_m.norm() * kBoxRoundedDown - region_of_interest_.core().radius()),
            farthest_m.norm() / kBoxRoundedDown + region_of_interest_.core().radius()};
}

void Pair::query_box() noexcept
{
    const Vec3 center_m = region_of_interest_.core().center();
    DistanceAnswer& answer = surface_.answer;
    if (!region_of_interest_.is_asleep())
    {
        const BoxGap gap = gap_to_box();
        answer.lower_m = gap.lower_m;
        answer.upper_m = gap.upper_m;
        answer.kind = answer.lower_m > region_of_interest_.reach_m() ? AnswerKind::separated
                                                                     : AnswerKind::bounded;
        answer.tool_point_m = center_m;
        region_of_interest_.remember(answer);
    }
    surface_.center_m = center_m;
    if (contacts_ != nullptr)
    {
        contacts_->clear();
        contacts_->is_complete =
            answer.lower_m * parts_.object->pose.scale > parts_.tool->spec().radius_m;
    }
    if (touches_ != nullptr)
    {
        touches_->clear();
    }
}

/// Number of meeting faces that ends a search. One is enough for the force of a rigid tool.
std::uint32_t Pair::enough_meeting() const noexcept
{
    return touches_ != nullptr && !parts_.tool->spec().wants_contacts ? 1 : kEnoughMeetingFaces;
}

/// Walks the object's tree for the surface in reach, within `budget`.
void Pair::gather(QueryMemory& memory, WalkBudget& budget, LocalSurface& surface) const noexcept
{
    gather_surface(parts_.model.model->tree, region_of_interest_.core(),
                   region_of_interest_.reach_m(), memory, budget, surface, proof_share(),
                   enough_meeting(), tolerance_.felt());
}

void Pair::query_core(const Budgets& budgets, WorkCounters& work, FrameFault& faults) noexcept
{
    if (!region_of_interest_.is_asleep())
    {
        LocalSurface& surface = surface_;
        WalkBudget budget{budgets.nodes, budgets.triangles};
        budget.frame = &work.budget;
        if (!parts_.rules->variant.starts_warm)
        {
            query_memory_ = QueryMemory{};
        }
        work.skipped.add(Skip::starts, query_memory_.block != kNoNode ? 1 : 0);
        gather(query_memory_, budget, surface);
        note_work_left(work.budget);
        work.nodes_visited += budget.nodes_visited;
        work.triangles_tested += budget.triangles_tested;
        faults |= budget.is_spent ? FrameFault::node_budget_spent : FrameFault::none;
        faults |= surface.truncated ? FrameFault::surface_truncated : FrameFault::none;
        narrow(surface.answer);
        region_of_interest_.remember(surface.answer);
    }
    report_core(work);
}

/// Reports contacts for the caller, and touches for the force, in the world frame.
void Pair::report_core(WorkCounters& work) noexcept
{
    const ToolSpec& tool = parts_.tool->spec();
    const ObjectPose& pose = parts_.object->pose;
    const Model& model = *parts_.model.model;
    if (tool.wants_contacts)
    {
        work.budget.spend(surface_.count * WorkCost::contact);
        report_contacts(region_of_interest_.core(), tool.radius_m / pose.scale, model.tree,
                        surface_, model.header.is_closed(), *contacts_);
        place_in_world(pose, *contacts_);
    }
    if (touches_ != nullptr)
    {
        touches_->clear();
        if (surface_.answer.lower_m > 0.0) // Otherwise the tool stays in place, or waits.
        {
            work.budget.spend(surface_.count * WorkCost::contact);
            report_touches(region_of_interest_.core(), region_of_interest_.reach_m(), model.tree,
                           surface_, *touches_);
            place_in_world(pose, *touches_);
        }
    }
}

/// Tightens the answer of a cut search by the last answer and the motion since.
void Pair::narrow(DistanceAnswer& answer) const noexcept
{
    if (answer.kind == AnswerKind::bounded && region_of_interest_.has_bounds())
    {
        const DistanceAnswer known = region_of_interest_.from_motion();
        answer.upper_m = std::min(answer.upper_m, known.upper_m);
        answer.lower_m = std::min(std::max(answer.lower_m, known.lower_m), answer.upper_m);
        answer.kind = answer.lower_m > region_of_interest_.reach_m() ? AnswerKind::separated
                                                                     : AnswerKind::bounded;
    }
}

void Pair::query_mesh(WorkCounters& work, FrameFault& faults) noexcept
{
    TACTUS_ASSERT(contacts_ != nullptr); // Each mesh has a report.
    const ToolSpec& tool = parts_.tool->spec();
    const ObjectPose& pose = parts_.object->pose;
    DistanceAnswer& answer = surface_.answer;
    ContactReport& contacts = *contacts_;
    // A tool that waits to be clear only needs the intersection test, and no touches.
    TouchReport* touches = parts_.tool->is_held() ? touches_ : nullptr;
    if (touches_ != nullptr)
    {
        touches_->clear();
    }
    if (region_of_interest_.is_asleep())
    {
        mesh_->rest(contacts);
    }
    else
    {
        const double radius_m = tool.radius_m / pose.scale;
        const double contact_m = touches != nullptr
                                     ? mesh_->touch_m(radius_m, region_of_interest_.reach_m())
                                 : tool.wants_contacts ? radius_m
                                                       : -1.0;
        const FrameVariant& variant = parts_.rules->variant;
        const bool is_proven = variant.fixed_radius == 0.0;
        // One pair is enough for a force, as the tool does not move while any faces meet.
        const std::uint32_t enough = tool.wants_pairs      ? kAllMeetingFaces
                                     : tool.wants_contacts ? kEnoughMeetingFaces
                                                           : 1;
        mesh_->query(region_of_interest_, is_proven ? mesh_->certified_m(refine_memories_[0]) : 0.0,
                     contact_m, enough, tolerance_.felt(),
                     touches != nullptr ? &touches->ends : nullptr, answer, contacts);
        note_work_left(work.budget);
        narrow(answer);
        mesh_->note_lower(answer.lower_m);
        region_of_interest_.remember(answer);
        if (touches != nullptr)
        {
            touches->nearest = contacts.contacts;
            touches->is_truncated = contacts.contacts.full() && !contacts.is_complete;
            touches->covered_m =
                touches->is_truncated ? contacts.contacts[kMaxContacts - 1].distance_m : contact_m;
            for (const Contact& contact : contacts.contacts)
            {
                keep_slab(contact.normal, contact.distance_m, *touches);
            }
            place_in_world(pose, *touches);
            keep_within(radius_m, answer, contacts);
        }
        place_in_world(pose, contacts);
    }
    mesh_->add_work(work, faults);
}

/// Bound on the rounding of the distances by the conversion to the world.
double Pair::rounding_m() const noexcept
{
    const ObjectPose& pose = parts_.object->pose;
    const double offset_m = mesh_ == nullptr ? 0.0 : mesh_core_of(*parts_.tool).origin_m.norm();
    const double origin_m = parts_.model.model->header.origin_m().norm() * pose.scale;
    return pose_rounding_m(pose, to_world(pose, region_of_interest_.core().center()),
                           region_of_interest_.core().radius() * pose.scale + offset_m) +
           kOriginRounding * origin_m;
}

void Pair::warm_caches(const SurfaceRoom& room, const Budgets& budgets,
                       WorkBudget& work) const noexcept
{
    if (region_of_interest_.has_known() && !region_of_interest_.is_asleep() && mesh_ == nullptr &&
        is_model_here_)
    {
        WalkBudget budget{budgets.nodes, budgets.triangles};
        budget.frame = &work;
        QueryMemory memory = query_memory_;
        LocalSurface surface = room.surface();
        gather(memory, budget, surface);
    }
}

PlacedSurface Pair::placed() noexcept
{
    const auto quantum_m = static_cast<double>(parts_.model.model->header.quantum_m());
    const ObjectPose& pose = parts_.object->pose;
    return {.pose = &pose,
            .surface = &surface_,
            .material = &material_.felt(),
            .quantum_m = quantum_m,
            .reach_m = region_of_interest_.reach_m() * pose.scale,
            .lower_m = lower_m_,
            .touches = touches_,
            .upper_m = upper_m_,
            .object = parts_.object_number,
            .memory = &body_,
            .kernels = &parts_.model.model->tree.kernels()};
}

PairOutput Pair::output() const noexcept
{
    const ObjectPose& pose = parts_.object->pose;
    const DistanceAnswer& answer = surface_.answer;
    // With wants_distance the nearest point may be known beyond the reach; the force does not use
    // it.
    const bool is_nearest_known =
        answer.kind == AnswerKind::separated && tells_distance() && !answer.nearest_face.is_none();
    const AnswerKind known =
        answer.tolerated_m == 0.0 ? AnswerKind::exact : AnswerKind::within_tolerance;
    return {.tool = parts_.tool_index,
            .object = parts_.object_number,
            .kind = is_nearest_known ? known : answer.kind,
            .tool_m = asked_.translation_m,
            .tool_rotation = asked_.rotation,
            .point_m = to_world(pose, answer.tool_point_m),
            .lower_m = lower_m_,
            .upper_m = upper_m_,
            .certified_radius_m = std::max(0.0, answer.certified_radius_m) * pose.scale,
            .tolerated_m = answer.tolerated_m * pose.scale,
            .nearest_face = answer.nearest_face,
            .nearest_point_m = to_world(pose, answer.nearest_point_m),
            .skipped = region_of_interest_.is_asleep(),
            .nearest_feature = answer.nearest_feature,
            .is_shed = is_shed_,
            .is_joined = is_joined_,
            .damping_n_s_per_m = material_.felt().damping_n_s_per_m,
            .contacts = parts_.tool->spec().wants_contacts ? contacts_ : nullptr,
            .mesh = mesh_ == nullptr ? nullptr : &mesh_->report()};
}

} // namespace tactus
