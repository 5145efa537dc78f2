// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/frame.hpp"

#include "rt_core/frame/validate_model.hpp"
#include "rt_core/geometry/believed_motion.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

/// Guests are brought as far ahead of a tool, however slow: what a hand at 2 m/s comes to in 80 ms,
/// a round trip of 20 ms and what asking, sending and entering take beside it.
constexpr double kGuestLead_m = 0.16;

/// Round a model's box, in its frame.
Ball model_ball(const ModelHeader& header) noexcept
{
    const auto& extent = header.fields().extent_quanta;
    const auto quantum_m = static_cast<double>(header.quantum_m());
    const Vec3 half_m = 0.5 * quantum_m * Vec3(extent[0], extent[1], extent[2]);
    return {half_m, half_m.norm()};
}

} // namespace

Result<Done, FrameRefusal> Frame::start(std::optional<Frame>& frame, Arena& arena,
                                        const FrameSetup& setup) noexcept
{
    if (const std::optional<FrameRefusal> refusal = find_refusal(setup))
    {
        return *refusal;
    }
    if (!arena.is_measuring() && arena.left() < required_bytes(setup))
    {
        return FrameRefusal::memory_too_small;
    }
    frame.emplace(PassKey{}, arena, setup);
    if (frame->model_count() != setup.models.size())
    {
        frame.reset();
        return FrameRefusal::base_refused;
    }
    return Done{};
}

std::size_t Frame::required_bytes(const FrameSetup& setup) noexcept
{
    Arena arena = Arena::measuring();
    const Frame measured(PassKey{}, arena, setup);
    return arena.used();
}

Frame::Frame(PassKey /*key*/, Arena& arena, const FrameSetup& setup) noexcept
    : rules_{setup.period_ns, setup.pose_age_max_ns, setup.prediction, setup.variant}
    , pools_(arena, pool_capacities(setup), static_cast<std::uint32_t>(setup.models.size()))
    , refinement_(std::ranges::any_of(setup.tools, &is_mesh))
    , life_(setup.period_ns)
    , has_guests_(setup.for_guests.base_cells > 0)
{
    if (try_take_models(arena, setup))
    {
        const SceneCapacities capacities = capacities_of(setup);
        objects_ = ObjectTable(arena, capacities.objects);
        broad_ =
            BroadPhase(arena, capacities.objects, static_cast<std::uint32_t>(setup.tools.size()));
        take_tools(arena, setup);
        take_pairs(arena, setup, capacities.pairs);
        if (!arena.is_measuring())
        {
            take_objects(setup);
        }
    }
}

/// False where a base mesh is damaged; start() sees that its model is missing.
bool Frame::try_take_models(Arena& arena, const FrameSetup& setup) noexcept
{
    const std::size_t count = setup.models.size();
    models_ = ModelSet(arena, count);
    is_shown_ = arena.take<bool>(count);
    model_outputs_ = arena.take<ModelOutput>(count);
    for (std::uint32_t i = 0; i < count; ++i)
    {
        std::optional<Model> measured;
        std::optional<Model>& model = arena.is_measuring() ? measured : models_.next();
        if (!try_take_model(model, arena, pools_, {i}, setup))
        {
            return false;
        }
        if (!arena.is_measuring())
        {
            is_shown_[i] = true;
            models_.add(frame_);
        }
    }
    pools_.cache.set_period(setup.period_ns);
    return true;
}

void Frame::take_tools(Arena& arena, const FrameSetup& setup) noexcept
{
    tools_ = arena.take<Tool>(setup.tools.size());
    planes_ = arena
                  .take<RigidProxy::Planes>(
                      std::ranges::any_of(setup.tools, &Tool::is_held_as_body) ? 1 : 0)
                  .data();
    for (std::size_t i = 0; i < setup.tools.size() && !arena.is_measuring(); ++i)
    {
        const auto* mesh = std::get_if<MeshCore>(&setup.tools[i].core);
        const ModelId model = mesh != nullptr ? mesh->model : ModelId{0};
        is_shown_[model.value] = is_shown_[model.value] && mesh == nullptr;
        tools_[i] = Tool(described(setup.tools[i], models_[model].header), planes_);
    }
}

void Frame::take_pairs(Arena& arena, const FrameSetup& setup, std::uint32_t count) noexcept
{
    pairs_ = AwakePairs(arena, setup.tools, count);
    const std::size_t triangles = kMaxLocalTriangles * std::min<std::size_t>(count, kLocalSurfaces);
    room_ = {arena.take<LocalTriangle>(triangles), arena.take<double>(triangles)};
}

void Frame::take_objects(const FrameSetup& setup) noexcept
{
    for (std::uint32_t i = 0; i < setup.objects.size(); ++i)
    {
        SceneChange change;
        change.kind = SceneChangeKind::object_comes;
        change.number = i;
        change.object = setup.objects[i];
        change.pose = i < setup.poses.size() ? setup.poses[i] : ObjectPose{};
        const Vec3 origin_m = models_[change.object.model].header.origin_m();
        objects_.make(change, origin_m, 0);
        place(i);
    }
}

FrameOutput Frame::run(const FrameInput& input, StageMark mark) noexcept
{
    const Budgets& budgets = input.budgets;
    ++frame_;
    work_ = WorkCounters{};
    scene_.walks = 0;
    scene_.refused = {};
    faults_ = FrameFault::none;
    budgets_ = budgets;
    rules_.now_ns = input.now_ns;
    rules_.frame = frame_;
    pools_.cache.forget_taken();
    change_scene(input.changes);
    begin(input.tools);
    if (try_rest(input))
    {
        for (const Stage stage :
             {Stage::load, Stage::refine, Stage::refit, Stage::query, Stage::force})
        {
            mark(stage);
        }
        return output();
    }
    find_neighbours();
    for (Pair* pair : pairs_.all())
    {
        pair->place(budgets);
    }
    pairs_.order();
    faults_ |= shedding_.shed(pairs_.by_urgency()) ? FrameFault::pair_shed : FrameFault::none;
    wake_models();
    load(budgets);
    mark(Stage::load);
    refine(budgets);
    mark(Stage::refine);
    refit();
    mark(Stage::refit);
    query();
    mark(Stage::query);
    respond();
    report();
    mark(Stage::force);
    return output();
}

void Frame::rehearse() noexcept
{
    for (const Pair* pair : pairs_.all())
    {
        pair->rehearse(room_, budgets_); // Nobody asks for the last frame's surfaces any more.
    }
}

/// Before anything else, so that all of the frame sees one scene.
void Frame::change_scene(std::span<const SceneChange> changes) noexcept
{
    const std::size_t taken = std::min<std::size_t>(changes.size(), kMaxSceneChanges);
    for (const SceneChange& change : changes.first(taken))
    {
        if (const std::optional<ChangeRefusal> refusal = try_change(change))
        {
            ++scene_.refused[static_cast<std::size_t>(*refusal)];
        }
    }
    scene_.refused[static_cast<std::size_t>(ChangeRefusal::too_many)] +=
        static_cast<std::uint32_t>(changes.size() - taken);
}

std::optional<ChangeRefusal> Frame::try_change(const SceneChange& change) noexcept
{
    if (change.kind == SceneChangeKind::tool_comes || change.kind == SceneChangeKind::tool_goes)
    {
        return try_change_tool(change);
    }
    const std::optional<ChangeRefusal> refusal =
        objects_.find_refusal(change, std::span(is_shown_).first(models_.size()));
    if (refusal)
    {
        return refusal;
    }
    const bool comes = change.kind == SceneChangeKind::object_comes;
    const ModelId model = comes ? change.object.model : objects_[change.number].spec.model;
    const ObjectPose before = objects_[change.number].pose;
    objects_.make(change, models_[model].header.origin_m(), frame_);
    if (change.kind != SceneChangeKind::object_goes)
    {
        if (has_pose(change.kind))
        {
            place(change.number);
        }
        if (change.kind == SceneChangeKind::object_moves)
        {
            look_for_leap(change.number, before);
        }
        return std::nullopt;
    }
    broad_.remove(change.number);
    for (std::size_t i = pairs_.all().size(); i > 0; --i)
    {
        Pair& pair = *pairs_.all()[i - 1];
        if (pair.object() == change.number)
        {
            tools_[pair.tool()].forget(pair.placed());
            end_pair(pair);
        }
    }
    return std::nullopt;
}

/// A tool that comes knows nothing of what was before.
std::optional<ChangeRefusal> Frame::try_change_tool(const SceneChange& change) noexcept
{
    if (change.number >= tools_.size())
    {
        return ChangeRefusal::number_too_big;
    }
    Presence& presence = presences_[change.number];
    const bool comes = change.kind == SceneChangeKind::tool_comes;
    if (presence.is_here == comes)
    {
        return comes ? ChangeRefusal::already_here : ChangeRefusal::not_here;
    }
    presence.is_here = comes;
    presence.clear_m = 0.0;
    broad_.forget(change.number);
    for (std::size_t i = pairs_.all().size(); i > 0; --i)
    {
        if (pairs_.all()[i - 1]->tool() == change.number)
        {
            end_pair(*pairs_.all()[i - 1]);
        }
    }
    tools_[change.number] = Tool(tools_[change.number].spec(), planes_);
    return std::nullopt;
}

/// The object's ball holds its model's box, and what it may be off by there.
void Frame::place(std::uint32_t object) noexcept
{
    const ObjectPose& pose = objects_[object].pose;
    const ModelHeader& header = models_[objects_[object].spec.model].header;
    const Ball ball = model_ball(header);
    const Vec3 center_m = to_world(pose, ball.center);
    const double radius_m = pose.scale * ball.radius;
    const double off_m = pose_rounding_m(pose, center_m, radius_m) +
                         kOriginRounding * header.origin_m().norm() * pose.scale;
    broad_.place(object, {center_m, radius_m + off_m});
}

/// Of tools that have no eye on the object: it was too far away in the last frame.
void Frame::look_for_leap(std::uint32_t object, const ObjectPose& before) noexcept
{
    const ObjectPose& now = objects_[object].pose;
    const Ball ball = model_ball(models_[objects_[object].spec.model].header);
    for (std::uint32_t i = 0; i < tools_.size(); ++i)
    {
        if (presences_[i].is_here && std::ranges::none_of(pairs_.of(i), [object](const Pair* pair)
                                                          { return pair->object() == object; }))
        {
            tools_[i].look_for_leap(before, now, ball);
            const Ball reach = tools_[i].reach_ball();
            presences_[i].leap_m = std::max(presences_[i].leap_m,
                                            way_in_ball_m(before, now, reach.center, reach.radius));
        }
    }
}

/// Places the tools, before anything is asked where they are.
void Frame::begin(std::span<const ToolState> tools) noexcept
{
    TACTUS_ASSERT(tools.size() == tools_.size());
    const double period_s = static_cast<double>(rules_.period_ns) * 1e-9;
    for (std::uint32_t i = 0; i < tools.size(); ++i)
    {
        if (!presences_[i].is_here)
        {
            continue;
        }
        StaticVector<NearObject, kMaxNear> near;
        for (Pair* pair : pairs_.of(i))
        {
            if (!pair->has_moved())
            {
                pair->stand();
            }
            else if (pair->is_joined())
            {
                near.push_back(pair->near());
            }
        }
        if (!near.empty()) // What moved may take the tool along, past what stands.
        {
            for (Pair* pair : pairs_.of(i))
            {
                if (!pair->has_moved() && pair->is_joined())
                {
                    near.push_back(pair->near());
                }
            }
        }
        faults_ |= tools_[i].begin(tools[i], period_s, near.view());
    }
}

/// What is near each tool becomes a pair, as far as there is room; to the rest it is proven clear.
void Frame::find_neighbours() noexcept
{
    for (std::uint32_t i = 0; i < tools_.size(); ++i)
    {
        if (presences_[i].is_here)
        {
            const bool is_far_of_use =
                tools_[i].spec().wants_distance || !rules_.variant.finds_neighbours;
            double near_m = is_far_of_use ? kInfinity : tools_[i].near_m();
            near_m = has_guests_ ? std::max(near_m, tools_[i].ball().radius +
                                                        tools_[i].stance().reach_m + kGuestLead_m)
                                 : near_m;
            broad_.look(i, tools_[i].ball().center, near_m);
        }
    }
    broad_.walk();
    const Nearness first_out = first_left_out();
    const bool has_room_for_all = first_out == kNobody;
    if (!has_room_for_all || paired_lists_ != broad_.lists())
    {
        pair_up(first_out);
    }
    paired_lists_ = has_room_for_all ? broad_.lists() : 0;
    scene_.objects = broad_.objects();
    scene_.pairs = static_cast<std::uint32_t>(pairs_.all().size());
    scene_.walks = broad_.walks();
    find_clearances(first_out);
}

/// Of what is near and has no room to be a pair, the nearest.
Frame::Nearness Frame::first_left_out() const noexcept
{
    StaticVector<Nearness, std::size_t{kMaxTools} * kMaxNear> each;
    std::size_t near = 0;
    for (std::uint32_t tool = 0; tool < tools_.size(); ++tool)
    {
        near += broad_.near(tool).size();
    }
    if (near <= pairs_.capacity())
    {
        return kNobody;
    }
    for (std::uint32_t tool = 0; tool < tools_.size(); ++tool)
    {
        for (const std::uint32_t object : broad_.near(tool))
        {
            each.push_back(nearness(tool, object));
        }
    }
    auto* const first_out = each.begin() + pairs_.capacity();
    std::nth_element(each.begin(), first_out, each.end());
    return *first_out;
}

/// How far beyond where the object could matter to the tool in this frame; no two are alike.
Frame::Nearness Frame::nearness(std::uint32_t tool, std::uint32_t object) const noexcept
{
    const double gap_m =
        broad_.gap_m(tool, object) - tools_[tool].ball().radius - tools_[tool].stance().reach_m;
    return {gap_m, tool * kMaxObjects + object};
}

/// Pairs that are nearer than `first_out` go on or begin, others end.
void Frame::pair_up(const Nearness& first_out) noexcept
{
    for (std::size_t i = pairs_.all().size(); i > 0; --i)
    {
        Pair& pair = *pairs_.all()[i - 1];
        if (!std::ranges::binary_search(broad_.near(pair.tool()), pair.object()) ||
            !(nearness(pair.tool(), pair.object()) < first_out))
        {
            end_pair(pair);
        }
    }
    for (std::uint32_t tool = 0; tool < tools_.size(); ++tool)
    {
        for (const std::uint32_t object : broad_.near(tool))
        {
            if (nearness(tool, object) < first_out &&
                !std::ranges::any_of(pairs_.of(tool), [object](const Pair* pair)
                                     { return pair->object() == object; }))
            {
                begin_pair(tool, object);
            }
        }
    }
}

/// Of everything that is no pair.
void Frame::find_clearances(const Nearness& first_out) noexcept
{
    scene_.crowded_tools = 0;
    scene_.walled_tools = 0;
    for (std::uint32_t tool = 0; tool < tools_.size(); ++tool)
    {
        Presence& presence = presences_[tool];
        presence.leap_m = 0.0;
        if (!presence.is_here)
        {
            continue;
        }
        double clear_m = broad_.clear_m(tool);
        for (const std::uint32_t object : broad_.near(tool))
        {
            const bool is_pair = first_out == kNobody || nearness(tool, object) < first_out;
            clear_m = is_pair ? clear_m : std::min(clear_m, broad_.gap_m(tool, object));
        }
        presence.clear_m = clear_m - tools_[tool].ball().radius;
        presence.is_crowded = presence.clear_m < tools_[tool].stance().reach_m;
        scene_.crowded_tools += presence.is_crowded ? 1U : 0U;
        faults_ |= presence.is_crowded ? FrameFault::scene_crowded : FrameFault::none;
        work_.skipped.add(Skip::objects,
                          scene_.objects - static_cast<std::uint32_t>(pairs_.of(tool).size()));
    }
}

void Frame::begin_pair(std::uint32_t tool, std::uint32_t object) noexcept
{
    const ModelId model = objects_[object].spec.model;
    PairParts parts;
    parts.tool_index = tool;
    parts.object_number = object;
    parts.rules = &rules_;
    parts.tool = &tools_[tool];
    parts.object = &objects_[object];
    parts.model = {model, &models_[model]};
    parts.begins_apart = begins_apart(tool, object);
    if (const auto* mesh = std::get_if<MeshCore>(&tools_[tool].spec().core); mesh != nullptr)
    {
        parts.tool_model = {mesh->model, &models_[mesh->model]};
    }
    pairs_.begin(parts);
}

/// Unless both were proven apart in the last frame, by more than an object that moves has gone
/// since, one has come round the other. What a frame starts with is where it is meant to be.
bool Frame::begins_apart(std::uint32_t tool, std::uint32_t object) const noexcept
{
    const Presence& presence = presences_[tool];
    const bool has_moved = objects_[object].moved_frame == frame_;
    const double ways_m = has_moved ? presence.leap_m + tools_[tool].went_m() : 0.0;
    return frame_ > ChunkCache::kFirstFrame + 1 &&
           (objects_[object].came_frame == frame_ ||
            !(presence.clear_m - ways_m > tools_[tool].radius_m()));
}

/// What is open for it in its models is of no use any more.
void Frame::end_pair(Pair& pair) noexcept
{
    const PairParts& parts = pair.parts();
    models_[parts.model.id].refiner.release(pair.object_closure());
    if (parts.tool_model.model != nullptr)
    {
        models_[parts.tool_model.id].refiner.release(pair.tool_closure());
    }
    pairs_.end(pair);
}

/// Adopt, predict, request.
void Frame::load(const Budgets& budgets) noexcept
{
    ranking_.clear();
    ranking_.lacks_present = false;
    for (Pair* pair : pairs_.by_urgency())
    {
        pair->rank(ranking_);
    }
    for (const Pair* pair : pairs_.by_urgency())
    {
        pair->rank_distance(ranking_);
    }
    faults_ |= ranking_.lacks_present ? FrameFault::ranking_full : FrameFault::none;
    pools_.cache.adopt_arrivals(budgets.pages, frame_, work_);
    if (has_guests_)
    {
        life_.go_on(models_, pairs_.by_urgency(), frame_, work_);
    }
    for (std::uint32_t i = 0; i < models_.busy().size(); ++i)
    {
        const ModelId id = models_.in_turn(i, frame_);
        models_[id].load(id, ranking_, budgets, frame_, work_, faults_);
    }
}

/// What a pair is of is looked at.
void Frame::wake_models() noexcept
{
    for (const Pair* pair : pairs_.all())
    {
        const PairParts& parts = pair->parts();
        models_.wake(parts.model.id, frame_);
        if (parts.tool_model.model != nullptr)
        {
            models_.wake(parts.tool_model.id, frame_);
        }
    }
    work_.skipped.add(Skip::models,
                      models_.size() - static_cast<std::uint32_t>(models_.busy().size()));
}

/// Coarsen, refine.
void Frame::refine(const Budgets& budgets) noexcept
{
    const std::uint32_t refused =
        refinement_.run({models_, budgets, frame_, work_, faults_}, pairs_.by_urgency());
    shedding_.learn(std::min(refused, pools_.cache.refused_class()));
}

void Frame::refit() noexcept
{
    std::uint32_t boxes = 0;
    for (const ModelId id : models_.busy())
    {
        Model& model = models_[id];
        if (!rules_.variant.refits_changed_only)
        {
            model.tree.mark_all();
        }
        boxes += model.tree.blocks_used() + model.tree.nodes_used();
        model.refit(work_, faults_);
    }
    const std::uint32_t refitted = work_.blocks_refitted + work_.nodes_refitted;
    work_.skipped.add(Skip::boxes, boxes - std::min(boxes, refitted));
}

/// A tool rests where nothing is otherwise than when it answered last.
void Frame::find_resting() noexcept
{
    for (std::uint32_t i = 0; i < tools_.size(); ++i)
    {
        Presence& presence = presences_[i];
        const std::span<Pair* const> pairs = pairs_.of(i);
        presence.rests =
            presence.is_here && rules_.variant.lets_tools_rest && tools_[i].is_settled() &&
            std::max(presence.clear_m, 0.0) == tool_outputs_[i].clear_m &&
            std::ranges::all_of(pairs, [](const Pair* pair) { return pair->is_unchanged(); });
        work_.skipped.add(Skip::tools, presence.rests ? 1 : 0);
    }
}

/// Whether the frame is the last one once more: nothing is left to do for anybody.
bool Frame::try_rest(const FrameInput& input) noexcept
{
    if (!may_rest_ || !rules_.variant.lets_frames_rest || !input.changes.empty())
    {
        return false;
    }
    for (std::uint32_t i = 0; i < tools_.size(); ++i)
    {
        if (presences_[i].is_here && !tools_[i].is_settled())
        {
            return false;
        }
    }
    for (std::uint32_t i = 0; i < tools_.size(); ++i)
    {
        faults_ |= frame_faults(tool_outputs_[i]);
        faults_ |= presences_[i].is_crowded ? FrameFault::scene_crowded : FrameFault::none;
    }
    pools_.cache.adopt_arrivals(input.budgets.pages, frame_, work_);
    work_.skipped.add(Skip::frames);
    return true;
}

/// The most urgent first: what they leave of the frame's walks is for the others.
void Frame::query() noexcept
{
    walked_.nodes = 0;
    walked_.triangles = 0;
    room_left_ = room_;
    find_resting();
    for (Pair* pair : pairs_.by_urgency())
    {
        if (presences_[pair->tool()].rests)
        {
            continue;
        }
        const WorkCounters before = work_;
        room_left_ = pair->query(room_left_, walks_left(), work_, faults_);
        if (!pair->is_of_mesh()) // Those have an allowance of their own: kMeshBudgetFactor.
        {
            walked_.nodes += work_.nodes_visited - before.nodes_visited;
            walked_.triangles += work_.triangles_tested - before.triangles_tested;
        }
    }
}

Budgets Frame::walks_left() const noexcept
{
    Budgets left = budgets_;
    left.nodes = walk_left(budgets_.nodes, walked_.nodes);
    left.triangles = walk_left(budgets_.triangles, walked_.triangles);
    return left;
}

void Frame::respond() noexcept
{
    for (std::uint32_t i = 0; i < tools_.size(); ++i)
    {
        const Presence& presence = presences_[i];
        ToolOutput& output = tool_outputs_[i];
        if (!presence.is_here)
        {
            output = ToolOutput{};
            output.is_gone = true;
            continue;
        }
        if (!presence.rests)
        {
            output = respond(i);
        }
        faults_ |= frame_faults(output);
        const bool is_walled =
            presence.is_crowded ||
            std::ranges::any_of(pairs_.of(i), [](const Pair* pair) { return pair->is_wall(); });
        scene_.walled_tools += is_walled && (output.frozen || output.under_way) ? 1U : 0U;
    }
}

/// A tool goes on while it has a way to go, what is near being asked for where it came to.
ToolOutput Frame::respond(std::uint32_t tool) noexcept
{
    const double clear_m = presences_[tool].clear_m;
    double clear_left_m = clear_m;
    const std::uint32_t planes = walk_left(budgets_.planes, work_.planes_looked_at);
    std::uint32_t planes_left = planes;
    ToolOutput output = step(tool, clear_m, planes_left);
    for (std::uint32_t i = 1; i < RigidProxy::kStepsPerFrame; ++i)
    {
        if (output.squeezed || !tools_[tool].try_go_on(clear_left_m) || !try_query_again(tool))
        {
            break;
        }
        const ToolOutput next = step(tool, clear_left_m, planes_left);
        if (next.frozen)
        {
            break; // The last one's force is of a place that is known.
        }
        output = next;
    }
    work_.planes_looked_at += planes - planes_left;
    return tools_[tool].finish(output, clear_m);
}

/// False where a walk has no whole budget left: its answer could prove less than the last one's.
bool Frame::try_query_again(std::uint32_t tool) noexcept
{
    const std::span<Pair* const> pairs = pairs_.of(tool);
    const bool is_of_mesh = is_mesh(tools_[tool].spec());
    for (Pair* pair : pairs)
    {
        const Budgets left = is_of_mesh ? budgets_ : walks_left();
        if (left.nodes < budgets_.nodes || left.triangles < budgets_.triangles)
        {
            return false;
        }
        const WorkCounters before = work_;
        room_left_ = pair->query_again(room_left_, left, work_, faults_);
        walked_.nodes += is_of_mesh ? 0 : work_.nodes_visited - before.nodes_visited;
        walked_.triangles += is_of_mesh ? 0 : work_.triangles_tested - before.triangles_tested;
    }
    return true;
}

ToolOutput Frame::step(std::uint32_t tool, double clear_m, std::uint32_t& planes) noexcept
{
    StaticVector<PlacedSurface, kMaxNear> near;
    for (Pair* pair : pairs_.of(tool))
    {
        if (pair->is_joined())
        {
            near.push_back(pair->placed());
        }
    }
    return tools_[tool].step(near.view(), clear_m, planes);
}

void Frame::report() noexcept
{
    for (std::size_t i = 0; i < pairs_.all().size(); ++i)
    {
        pair_outputs_[i] = pairs_.all()[i]->output();
        pairs_.all()[i]->remember();
    }
    for (const ModelId id : models_.busy())
    {
        validate(models_[id]);
        model_outputs_[id.value] = models_[id].output();
    }
    may_rest_ = true;
    for (std::uint32_t i = 0; i < tools_.size(); ++i)
    {
        may_rest_ = may_rest_ && (presences_[i].rests || !presences_[i].is_here);
    }
    for (const ModelId id : models_.busy())
    {
        may_rest_ = may_rest_ && models_[id].is_complete();
    }
    if (rules_.variant.asks_near_models_only)
    {
        models_.let_rest(frame_);
    }
}

FrameOutput Frame::output() const noexcept
{
    return {{tool_outputs_.data(), tools_.size()},
            {pair_outputs_.data(), pairs_.all().size()},
            model_outputs_,
            work_,
            faults_,
            pools_.cache.taken(),
            scene_};
}

} // namespace tactus
