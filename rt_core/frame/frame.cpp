// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/frame.hpp"

#include "rt_core/math/rotation.hpp"
#include "rt_core/query/contact_report.hpp"
#include "rt_core/query/core_query.hpp"
#include "rt_core/query/probe.hpp"

#include <algorithm>
#include <cstring>

namespace tactus
{

namespace
{

/// The ball is wider than the proxy's possible motion by this share of the tool's radius, so that
/// a front that lags by a frame or two still holds what the proxy needs.
constexpr double kReachMargin = 0.05;

/// Before contact a second ball is refined this far ahead in time, so that the front is there when
/// the tool is: a contact needs some 600 splits at 1 M faces, ten frames of 64.
constexpr double kApproachTime_s = 0.01;
/// Not worth a second ball: a share of the reach.
constexpr double kLeastAhead = 0.1;

bool is_mesh(const ToolSpec& tool) noexcept
{
    return std::holds_alternative<MeshCore>(tool.core);
}

/// Held back by surfaces as a body, with a force and a torque.
bool is_rigid(const ToolSpec& tool) noexcept
{
    return !tool.passes_through && !std::holds_alternative<PointCore>(tool.core);
}

/// What a tool that is a mesh has to know of its model.
MeshCore mesh_core(ModelId model, const ModelHeader& header) noexcept
{
    const HeaderFields& fields = header.fields();
    const auto quantum = static_cast<double>(header.quantum_m());
    MeshCore core{model, Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.0)};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const auto row = static_cast<Eigen::Index>(axis);
        core.origin_m[row] = fields.origin_m[axis];
        core.extent_m[row] = quantum * static_cast<double>(fields.extent_quanta[axis]);
    }
    return core;
}

/// From the model's frame to the world.
void place_in_world(const ObjectPose& pose, ContactSet& contacts) noexcept
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
    place_in_world(pose, report.contacts);
}

/// Of contacts that were looked for farther away: those within the radius.
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

} // namespace

const char* refusal_text(FrameRefusal refusal) noexcept
{
    switch (refusal)
    {
    case FrameRefusal::too_many:
        return "there are too many tools, objects or models, or none";
    case FrameRefusal::unknown_model:
        return "an object or a tool names a model that is not loaded";
    case FrameRefusal::shared_model:
        return "a tool names a model that an object shows";
    case FrameRefusal::header_refused:
        return "a model's header is damaged";
    case FrameRefusal::base_refused:
        return "a model's base mesh is damaged";
    case FrameRefusal::memory_too_small:
        return "the pools are too small for the models";
    }
    return "the frame can't be made";
}

Result<Done, FrameRefusal> Frame::start(std::optional<Frame>& frame, Arena& arena,
                                        const FrameSetup& setup) noexcept
{
    if (const std::optional<FrameRefusal> refusal = check(setup))
    {
        return *refusal;
    }
    if (!arena.is_measuring() && arena.left() < required_bytes(setup))
    {
        return FrameRefusal::memory_too_small;
    }
    frame.emplace(PassKey{}, arena, setup);
    if (frame->model_count_ != setup.models.size())
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

std::optional<FrameRefusal> Frame::check(const FrameSetup& setup) noexcept
{
    if (setup.tools.empty() || setup.tools.size() > kMaxTools || setup.objects.empty() ||
        setup.objects.size() > kMaxObjects || setup.models.empty() ||
        setup.models.size() > kMaxModels)
    {
        return FrameRefusal::too_many;
    }
    for (const ObjectSpec& object : setup.objects)
    {
        if (object.model.value >= setup.models.size())
        {
            return FrameRefusal::unknown_model;
        }
    }
    for (const ToolSpec& tool : setup.tools)
    {
        const auto* mesh = std::get_if<MeshCore>(&tool.core);
        if (mesh != nullptr && mesh->model.value >= setup.models.size())
        {
            return FrameRefusal::unknown_model;
        }
        if (mesh != nullptr && std::ranges::any_of(setup.objects, [mesh](const ObjectSpec& object)
                                                   { return object.model == mesh->model; }))
        {
            return FrameRefusal::shared_model;
        }
    }
    for (const ModelSource& source : setup.models)
    {
        if (!ModelHeader::parse(source.header))
        {
            return FrameRefusal::header_refused;
        }
    }
    return std::nullopt;
}

Frame::Frame(PassKey /*key*/, Arena& arena, const FrameSetup& setup) noexcept
    : scene_(setup.tools, setup.objects)
    , period_ns_(setup.period_ns)
    , pose_age_max_ns_(setup.pose_age_max_ns)
    , prediction_(setup.prediction)
    , variant_(setup.variant)
    , refine_memories_(arena.take<RefineMemory>(scene_.pairs().size() * kQuestions))
    , surfaces_(arena.take<LocalSurface>(scene_.pairs().size() + 1))
{
    const bool has_meshes = std::ranges::any_of(setup.tools, is_mesh);
    if (has_meshes ||
        std::ranges::any_of(setup.tools, [](const ToolSpec& tool) { return tool.wants_contacts; }))
    {
        contacts_ = arena.take<ContactReport>(scene_.pairs().size());
    }
    if (has_meshes)
    {
        mesh_pairs_ = arena.take<MeshPair>(scene_.pairs().size());
    }
    if (std::ranges::any_of(setup.tools, is_rigid))
    {
        rigid_proxies_ = arena.take<RigidProxy>(setup.tools.size());
        touches_ = arena.take<TouchReport>(scene_.pairs().size());
    }
    rotations_.fill(Mat3::Identity());
    for (const ToolSpec& tool : setup.tools)
    {
        proxies_.push_back(Proxy(tool));
    }
    goals_.fill(Vec3(0.0, 0.0, 0.0));
    goal_velocities_m_per_s_.fill(Vec3(0.0, 0.0, 0.0));
    for (const ModelSource& source : setup.models)
    {
        const std::span<std::byte> header_bytes = arena.take<std::byte>(source.header.size());
        std::span<const std::byte> kept = source.header;
        if (!arena.is_measuring())
        {
            std::memcpy(header_bytes.data(), source.header.data(), source.header.size());
            kept = header_bytes;
        }
        const ModelHeader header = ModelHeader::parse(kept).value();
        const PageSlots slots = PageSlots::take(arena, header.counts(), source.capacities.pages,
                                                source.capacities.index_pages);
        if (!arena.is_measuring() && !parse_base_mesh(source.base, header, slots.base))
        {
            return; // start() sees that a model is missing.
        }
        const Kernels& kernels = setup.kernels != nullptr ? *setup.kernels : best_kernels();
        Model& model =
            models_[model_count_].emplace(arena, header, slots, source.capacities, kernels);
        if (setup.static_when_it_fits && model.fits())
        {
            model.residence = Residence::filling;
        }
        scene_.describe_meshes(mesh_core(ModelId{model_count_}, header));
        ++model_count_;
    }
    if (!arena.is_measuring())
    {
        for (std::size_t i = 0; i < rigid_proxies_.size(); ++i)
        {
            rigid_proxies_[i] = RigidProxy(scene_.tools()[i]);
        }
    }
}

FrameOutput Frame::run(std::span<const ToolState> tools, std::span<const ObjectPose> poses,
                       const Budgets& budgets, StageMark mark) noexcept
{
    TACTUS_ASSERT(tools.size() == scene_.tools().size());
    TACTUS_ASSERT(poses.size() == scene_.objects().size());
    ++frame_;
    work_ = WorkCounters{};
    faults_ = FrameFault::none;
    last_budgets_ = budgets;
    read_tools(tools);
    carry_proxies(poses);
    place_pairs(poses, budgets);
    load(budgets);
    mark(Stage::load);
    refine(budgets);
    mark(Stage::refine);
    for (std::uint32_t i = 0; i < model_count_; ++i)
    {
        if (!variant_.refits_changed_only)
        {
            models_[i]->tree.mark_all();
        }
        models_[i]->refit(faults_);
    }
    mark(Stage::refit);
    query(poses, budgets);
    mark(Stage::query);
    respond(poses);
    report(poses);
    mark(Stage::force);
    return finish();
}

void Frame::rehearse() noexcept
{
    for (std::uint32_t i = 0; i < scene_.pairs().size(); ++i)
    {
        const ScenePair& pair = scene_.pairs()[i];
        if (pair.has_known && !pair.is_asleep && !pair.core.is_mesh())
        {
            WalkBudget budget{last_budgets_.nodes, last_budgets_.triangles};
            QueryMemory memory = query_memories_[i];
            gather_surface(models_[model_of(pair).value]->tree, pair.core, pair.reach_m, memory,
                           budget, surfaces_.back());
        }
    }
}

void Frame::read_tools(std::span<const ToolState> tools) noexcept
{
    for (std::size_t i = 0; i < tools.size(); ++i)
    {
        elapsed_s_[i] = static_cast<double>(period_ns_) * 1e-9 *
                        static_cast<double>(std::max(tools[i].elapsed_periods, 1U));
        const SampleWatch::Verdict verdict =
            sample_watches_[i].judge(tools[i], scene_.tools()[i], goals_[i], elapsed_s_[i]);
        faults_ |= verdict.fault;
        ways_m_[i] = 0.0;
        if (!verdict.is_taken)
        {
            continue;
        }
        const bool is_continued = !verdict.is_first && verdict.fault == FrameFault::none;
        const Mat3 rotation = orthonormalised(tools[i].rotation);
        const Vec3 way = is_continued ? Vec3(tools[i].position_m - goals_[i]) : Vec3(0.0, 0.0, 0.0);
        goal_velocities_m_per_s_[i] = is_continued ? Vec3(way / verdict.since_s) : way;
        if (is_continued)
        {
            const ToolCore& core = scene_.tools()[i].core;
            ways_m_[i] = PlacedCore(core, {rotation, way})
                             .motion_since(PlacedCore(core, {rotations_[i], Vec3(0.0, 0.0, 0.0)}));
        }
        goals_[i] = tools[i].position_m;
        rotations_[i] = rotation;
        if (verdict.is_first)
        {
            proxies_[i].start_at(goals_[i]);
        }
        if (RigidProxy* rigid = rigid_proxy(static_cast<std::uint32_t>(i)); rigid != nullptr)
        {
            rigid->stay_with(goals_[i], rotations_[i]);
        }
    }
}

/// Before anything is asked at the proxies' places.
void Frame::carry_proxies(std::span<const ObjectPose> poses) noexcept
{
    const std::span<const ObjectPose> before{last_poses_.data(), poses.size()};
    for (std::uint32_t tool = 0; tool < proxies_.size() && has_poses_; ++tool)
    {
        if (has_proxy(tool))
        {
            proxies_[tool].carry(before, poses, elapsed_s_[tool]);
        }
    }
    std::ranges::copy(poses, last_poses_.begin());
    has_poses_ = true;
}

/// A point that surfaces hold back.
bool Frame::has_proxy(std::uint32_t tool) const noexcept
{
    const ToolSpec& spec = scene_.tools()[tool];
    return !spec.passes_through && std::holds_alternative<PointCore>(spec.core);
}

/// Null unless surfaces hold the tool back as a body.
RigidProxy* Frame::rigid_proxy(std::uint32_t tool) noexcept
{
    return is_rigid(scene_.tools()[tool]) ? &rigid_proxies_[tool] : nullptr;
}

const RigidProxy* Frame::rigid_proxy(std::uint32_t tool) const noexcept
{
    return is_rigid(scene_.tools()[tool]) ? &rigid_proxies_[tool] : nullptr;
}

const Vec3& Frame::position_of(std::uint32_t tool) const noexcept
{
    const RigidProxy* rigid = rigid_proxy(tool);
    return rigid != nullptr  ? rigid->position_m()
           : has_proxy(tool) ? proxies_[tool].position_m()
                             : goals_[tool];
}

const Mat3& Frame::rotation_of(std::uint32_t tool) const noexcept
{
    const RigidProxy* rigid = rigid_proxy(tool);
    return rigid != nullptr ? rigid->rotation() : rotations_[tool];
}

/// How far round its core a tool asks for exact faces: its radius, and as far as it may move.
double Frame::reach_of(std::uint32_t tool) const noexcept
{
    const ToolSpec& spec = scene_.tools()[tool];
    const RigidProxy* rigid = rigid_proxy(tool);
    const double way = rigid != nullptr  ? rigid->way_to_m(goals_[tool], rotations_[tool])
                       : has_proxy(tool) ? proxies_[tool].way_to_m(goals_[tool])
                                         : ways_m_[tool];
    const double most = spec.speed_max_m_per_s * elapsed_s_[tool];
    return radius_of(tool) * (1.0 + kReachMargin) + std::min(way, most);
}

/// Within which of its core's place the proxy keeps surfaces out.
double Frame::radius_of(std::uint32_t tool) const noexcept
{
    const RigidProxy* rigid = rigid_proxy(tool);
    return rigid != nullptr ? rigid->radius_m() : proxies_[tool].radius_m();
}

/// How far a tool without contact comes in kApproachTime_s.
Vec3 Frame::ahead_of(std::uint32_t tool) const noexcept
{
    return tool_outputs_[tool].in_contact ? Vec3(0.0, 0.0, 0.0)
                                          : Vec3(kApproachTime_s * goal_velocities_m_per_s_[tool]);
}

ModelId Frame::model_of(const ScenePair& pair) const noexcept
{
    return scene_.objects()[pair.object].model;
}

void Frame::place_pairs(std::span<const ObjectPose> poses, const Budgets& budgets) noexcept
{
    for (ScenePair& pair : scene_.pairs())
    {
        scene_.place(pair, poses[pair.object], rotation_of(pair.tool), position_of(pair.tool),
                     reach_of(pair.tool), ahead_of(pair.tool));
        pair.is_asleep = pair.is_asleep && variant_.lets_pairs_rest;
        const bool is_reached =
            pair.has_known && pair.known.lower_m > 0.0 && pair.known.lower_m <= pair.motion_m();
        if (is_reached && rigid_proxy(pair.tool) != nullptr)
        {
            faults_ |= FrameFault::proxy_squeezed; // An object came as far as to its core.
        }
    }
    for (std::uint32_t i = 0; i < scene_.pairs().size(); ++i)
    {
        if (MeshPair* mesh = mesh_pair(i); mesh != nullptr)
        {
            const ScenePair& pair = scene_.pairs()[i];
            mesh->place(
                pair, *std::get_if<MeshCore>(&scene_.tools()[pair.tool].core),
                *models_[tool_model_of(pair).value], *models_[model_of(pair).value],
                place_in_model(poses[pair.object], rotation_of(pair.tool), position_of(pair.tool)),
                budgets);
        }
    }
}

/// Null unless the pair's tool is a mesh.
MeshPair* Frame::mesh_pair(std::uint32_t pair) noexcept
{
    return scene_.pairs()[pair].core.is_mesh() ? &mesh_pairs_[pair] : nullptr;
}

ModelId Frame::tool_model_of(const ScenePair& pair) const noexcept
{
    const auto* mesh = std::get_if<MeshCore>(&scene_.tools()[pair.tool].core);
    return mesh == nullptr ? ModelId{} : mesh->model;
}

bool Frame::is_complete(ModelId model) const noexcept
{
    return models_[model.value]->residence == Residence::complete;
}

void Frame::refine(const Budgets& budgets) noexcept
{
    for (std::uint32_t i = 0; i < model_count_; ++i)
    {
        ask_about(ModelId{i});
        models_[i]->refine(questions_.view(), budgets, frame_, faults_);
        if (!mesh_pairs_.empty())
        {
            models_[i]->refit(faults_); // The next model may ask how near its surface is.
        }
    }
}

/// What the pairs that are awake ask of a model: where they are and, coming nearer, where they will
/// be. Certificates of questions that are not asked are forgotten: the model may coarsen there.
void Frame::ask_about(ModelId model) noexcept
{
    questions_.clear();
    for (std::uint32_t i = 0; i < scene_.pairs().size(); ++i)
    {
        const ScenePair& pair = scene_.pairs()[i];
        if (mesh_pair(i) != nullptr)
        {
            ask_for_mesh(i, model);
        }
        else if (model_of(pair) == model)
        {
            ask_for_balls(i);
        }
    }
}

/// Not far ahead is not worth a second question.
bool Frame::looks_ahead(const ScenePair& pair) noexcept
{
    return !pair.is_asleep && pair.ahead_m.norm() > kLeastAhead * pair.reach_m;
}

void Frame::ask_for_balls(std::uint32_t i) noexcept
{
    const ScenePair& pair = scene_.pairs()[i];
    const std::span<RefineMemory> memories = refine_memories_.subspan(i * kQuestions, kQuestions);
    for (std::size_t ball = 0; ball < kMaxCoverBalls; ++ball)
    {
        const bool is_there = ball < pair.cover.size();
        const Ball here = is_there ? pair.cover[ball] : Ball{};
        const double reach_m = (here.radius + pair.reach_m) *
                               (variant_.fixed_radius > 0.0 ? variant_.fixed_radius : 1.0);
        const double keep_m = Scene::kKeepFactor * reach_m;
        ask(is_there && !pair.is_asleep, model_of(pair),
            {here.center, reach_m, keep_m, &memories[2 * ball]});
        ask(is_there && looks_ahead(pair), model_of(pair),
            {here.center + pair.ahead_m, reach_m, keep_m, &memories[2 * ball + 1]});
    }
}

void Frame::ask_for_mesh(std::uint32_t i, ModelId model) noexcept
{
    const ScenePair& pair = scene_.pairs()[i];
    MeshPair& mesh = *mesh_pair(i);
    for (std::size_t place = 0; place < MeshPair::kPlaces; ++place)
    {
        const bool is_asked = place == 0 ? !pair.is_asleep : looks_ahead(pair);
        if (model_of(pair) == model)
        {
            ask(is_asked, model,
                mesh.ask_object(place, pair, refine_memories_[i * kQuestions + place]));
        }
        if (tool_model_of(pair) == model)
        {
            ask(is_asked, model, mesh.ask_tool(place, pair));
        }
    }
}

void Frame::ask(bool is_asked, ModelId model, const RefineQuestion& question) noexcept
{
    if (!variant_.keeps_certificates)
    {
        question.memory->is_known = false;
    }
    // From beyond the kernels' range nothing of a model is in reach.
    if (is_asked && !is_beyond_kernels(question.center_m, models_[model.value]->header.quantum_m()))
    {
        RefineQuestion asked = question;
        asked.counts_errors = variant_.fixed_radius == 0.0;
        asked.tolerance_m = variant_.tolerance_m;
        questions_.push_back(asked);
        return;
    }
    question.memory->is_known = false;
}

void Frame::query(std::span<const ObjectPose> poses, const Budgets& budgets) noexcept
{
    for (std::uint32_t i = 0; i < scene_.pairs().size(); ++i)
    {
        const ScenePair& pair = scene_.pairs()[i];
        LocalSurface& surface = surfaces_[i];
        const ObjectPose& pose = poses[pair.object];
        if (pair.is_asleep)
        {
            surface.answer = Scene::from_motion(pair);
            surface.count = 0;
        }
        if (mesh_pair(i) != nullptr)
        {
            query_mesh(i, pose);
        }
        else
        {
            query_core(i, pose, budgets);
        }
        const std::uint32_t revision = models_[model_of(pair).value]->header.fields().revision;
        if (pose.age_ns > pose_age_max_ns_ || pose.revision != revision)
        {
            surface.answer.kind = AnswerKind::stale;
        }
    }
}

void Frame::query_core(std::uint32_t i, const ObjectPose& pose, const Budgets& budgets) noexcept
{
    ScenePair& pair = scene_.pairs()[i];
    LocalSurface& surface = surfaces_[i];
    const Model& model = *models_[model_of(pair).value];
    if (!pair.is_asleep)
    {
        WalkBudget budget{budgets.nodes, budgets.triangles};
        if (!variant_.starts_warm)
        {
            query_memories_[i] = QueryMemory{};
        }
        gather_surface(model.tree, pair.core, pair.reach_m, query_memories_[i], budget, surface);
        work_.nodes_visited += budget.nodes_visited;
        work_.triangles_tested += budget.triangles_tested;
        faults_ |= budget.is_spent ? FrameFault::node_budget_spent : FrameFault::none;
        faults_ |= surface.truncated ? FrameFault::surface_truncated : FrameFault::none;
        Scene::remember(pair, surface.answer);
    }
    if (scene_.tools()[pair.tool].wants_contacts)
    {
        report_contacts(pair.core, scene_.tools()[pair.tool].radius_m / pose.scale, model.tree,
                        surface, model.header.is_closed(), contacts_[i]);
        place_in_world(pose, contacts_[i]);
    }
    if (rigid_proxy(pair.tool) != nullptr)
    {
        report_touches(pair.core, pair.reach_m, model.tree, surface, touches_[i]);
        place_in_world(pose, touches_[i].nearest);
        place_in_world(pose, touches_[i].corners);
    }
}

void Frame::query_mesh(std::uint32_t i, const ObjectPose& pose) noexcept
{
    ScenePair& pair = scene_.pairs()[i];
    MeshPair& mesh = *mesh_pair(i);
    const ToolSpec& tool = scene_.tools()[pair.tool];
    const bool is_held = rigid_proxy(pair.tool) != nullptr;
    if (is_held)
    {
        touches_[i].clear();
    }
    if (pair.is_asleep)
    {
        mesh.rest(contacts_[i]);
    }
    else
    {
        const double radius_m = tool.radius_m / pose.scale;
        const double contact_m = is_held ? pair.reach_m : tool.wants_contacts ? radius_m : -1.0;
        surfaces_[i].count = 0;
        mesh.query(pair, contact_m, surfaces_[i].answer, contacts_[i]);
        Scene::remember(pair, surfaces_[i].answer);
        if (is_held)
        {
            touches_[i].nearest = contacts_[i].contacts;
            place_in_world(pose, touches_[i].nearest);
            keep_within(radius_m, surfaces_[i].answer, contacts_[i]);
        }
        place_in_world(pose, contacts_[i]);
    }
    mesh.add_work(work_, faults_);
}

void Frame::respond(std::span<const ObjectPose> poses) noexcept
{
    for (std::uint32_t tool = 0; tool < proxies_.size(); ++tool)
    {
        StaticVector<PlacedSurface, kMaxObjects> placed;
        for (std::uint32_t i = 0; i < scene_.pairs().size(); ++i)
        {
            const ScenePair& pair = scene_.pairs()[i];
            if (pair.tool == tool)
            {
                const ObjectPose& pose = poses[pair.object];
                const float quantum_m = models_[model_of(pair).value]->header.quantum_m();
                placed.push_back({&pose, &surfaces_[i], &scene_.objects()[pair.object].material,
                                  static_cast<double>(quantum_m), pair.reach_m * pose.scale});
            }
        }
        ToolOutput& output = tool_outputs_[tool];
        const ProxyGoal goal{goals_[tool], goal_velocities_m_per_s_[tool], elapsed_s_[tool]};
        output = has_proxy(tool)                ? proxies_[tool].respond(goal, placed.view())
                 : rigid_proxy(tool) != nullptr ? respond_rigidly(tool, poses)
                                                : follow(tool, placed.view());
        if (rigid_proxy(tool) == nullptr)
        {
            output.proxy_rotation = rotations_[tool];
        }
        const double trust =
            sample_watches_[tool].trust(output, scene_.tools()[tool], goals_[tool]);
        output.force_n *= trust;
        output.torque_nm *= trust;
        faults_ |= output.frozen ? FrameFault::proxy_frozen : FrameFault::none;
        faults_ |= output.squeezed ? FrameFault::proxy_squeezed : FrameFault::none;
    }
}

ToolOutput Frame::respond_rigidly(std::uint32_t tool, std::span<const ObjectPose> poses) noexcept
{
    StaticVector<TouchedObject, kMaxObjects> objects;
    for (std::uint32_t i = 0; i < scene_.pairs().size(); ++i)
    {
        const ScenePair& pair = scene_.pairs()[i];
        if (pair.tool == tool)
        {
            const ObjectPose& pose = poses[pair.object];
            objects.push_back({&pose, &touches_[i], surfaces_[i].answer.kind, lower_of(i, pose)});
        }
    }
    RigidProxy& rigid = *rigid_proxy(tool);
    ToolOutput output =
        rigid.respond(goals_[tool], rotations_[tool], objects.view(), elapsed_s_[tool]);
    output.squeezed = rigid.is_squeezed();
    return output;
}

/// A tool without a proxy: whether it touches is proven where an upper bound says so.
ToolOutput Frame::follow(std::uint32_t tool, std::span<const PlacedSurface> surfaces) const noexcept
{
    ToolOutput output;
    output.proxy_m = goals_[tool];
    for (const PlacedSurface& placed : surfaces)
    {
        const double upper_m = placed.surface->answer.upper_m * placed.pose->scale;
        output.in_contact = output.in_contact || upper_m <= scene_.tools()[tool].radius_m;
    }
    return output;
}

/// What a pair's distances may be off in the world.
double Frame::pair_rounding_m(std::uint32_t i, const ObjectPose& pose) noexcept
{
    const ScenePair& pair = scene_.pairs()[i];
    const auto* mesh = std::get_if<MeshCore>(&scene_.tools()[pair.tool].core);
    const double size_m =
        pair.core.radius() * pose.scale + (mesh == nullptr ? 0.0 : mesh->origin_m.norm());
    return pose_rounding_m(pose, to_world(pose, pair.core.center()), size_m);
}

/// The proven distance of a pair, in the world.
double Frame::lower_of(std::uint32_t i, const ObjectPose& pose) noexcept
{
    const double lower_m = surfaces_[i].answer.lower_m * pose.scale - pair_rounding_m(i, pose);
    return std::max(0.0, lower_m);
}

void Frame::report_pair(std::uint32_t i, const ObjectPose& pose) noexcept
{
    const ScenePair& pair = scene_.pairs()[i];
    const DistanceAnswer& answer = surfaces_[i].answer;
    const auto* mesh = std::get_if<MeshCore>(&scene_.tools()[pair.tool].core);
    pair_outputs_[i] = {pair.tool,
                        pair.object,
                        answer.kind,
                        to_world(pose, answer.tool_point_m),
                        lower_of(i, pose),
                        answer.upper_m * pose.scale + pair_rounding_m(i, pose),
                        std::max(0.0, answer.certified_radius_m) * pose.scale,
                        answer.nearest_face,
                        to_world(pose, answer.nearest_point_m),
                        pair.is_asleep,
                        answer.nearest_feature,
                        scene_.tools()[pair.tool].wants_contacts ? &contacts_[i] : nullptr,
                        mesh == nullptr ? nullptr : &mesh_pairs_[i].report()};
}

void Frame::report(std::span<const ObjectPose> poses) noexcept
{
    for (std::uint32_t i = 0; i < scene_.pairs().size(); ++i)
    {
        report_pair(i, poses[scene_.pairs()[i].object]);
    }
    for (std::uint32_t i = 0; i < model_count_; ++i)
    {
        const Model& model = *models_[i];
        work_ += model.work;
        const AbTree::Capacities& tree = model.tree.capacities();
        const std::uint32_t index_pages = model.cache.index_pages_used();
        model_outputs_[i] = {
            {model.pages.used(), model.pages_used_max, model.pages.capacity()},
            {index_pages, index_pages, model.capacities.index_pages},
            {model.forest.active_faces(), model.forest.active_faces_max(), model.forest.capacity()},
            {model.tree.blocks_used(), model.tree.blocks_used_max(), tree.blocks},
            {model.tree.nodes_used(), model.tree.nodes_used_max(), tree.nodes},
            model.forest.refined_records(),
            model.forest.state_hash(),
            model.residence == Residence::complete};
    }
}

FrameOutput Frame::finish() const noexcept
{
    return {{tool_outputs_.data(), proxies_.size()},
            {pair_outputs_.data(), scene_.tools().size() * scene_.objects().size()},
            {model_outputs_.data(), model_count_},
            work_,
            faults_,
            {door_takes_.data(), model_count_}};
}

} // namespace tactus
