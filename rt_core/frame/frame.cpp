// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/frame.hpp"

#include "rt_core/frame/validate_model.hpp"

#include <algorithm>

namespace tactus
{

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

Frame::Frame(PassKey /*key*/, Arena& arena, const FrameSetup& setup) noexcept
    : rules_{setup.period_ns, setup.pose_age_max_ns, setup.prediction, setup.variant}
    , has_meshes_(std::ranges::any_of(setup.tools, &is_mesh))
{
    for (const ObjectSpec& object : setup.objects)
    {
        objects_.push_back(object);
    }
    if (try_take_models(arena, setup))
    {
        take_tools(arena, setup);
        take_pairs(arena, setup);
    }
}

/// False where a base mesh is damaged; start() sees that its model is missing.
bool Frame::try_take_models(Arena& arena, const FrameSetup& setup) noexcept
{
    for (const ModelSource& source : setup.models)
    {
        if (!try_take_model(models_[model_count_], arena, source, setup))
        {
            return false;
        }
        ++model_count_;
    }
    return true;
}

void Frame::take_tools(Arena& arena, const FrameSetup& setup) noexcept
{
    tools_ = arena.take<Tool>(setup.tools.size());
    const auto planes = arena.take<RigidProxy::Planes>(
        std::ranges::any_of(setup.tools, &Tool::is_held_as_body) ? 1 : 0);
    for (std::size_t i = 0; i < setup.tools.size() && !arena.is_measuring(); ++i)
    {
        const auto* mesh = std::get_if<MeshCore>(&setup.tools[i].core);
        const ModelId model = mesh != nullptr ? mesh->model : ModelId{0};
        tools_[i] = Tool(described(setup.tools[i], models_[model.value]->header), planes.data());
    }
}

void Frame::take_pairs(Arena& arena, const FrameSetup& setup) noexcept
{
    const std::size_t count = setup.tools.size() * setup.objects.size();
    pairs_ = arena.take<Pair>(count);
    rehearsed_ = arena.take<LocalSurface>(1).data();
    const PairMemory memory = PairMemory::take(arena, setup.tools, count);
    for (std::size_t i = 0; i < count && !arena.is_measuring(); ++i)
    {
        const std::size_t tool = i / objects_.size();
        const std::size_t object = i % objects_.size();
        const ModelId model = objects_[object].model;
        PairParts parts;
        parts.tool_index = static_cast<std::uint32_t>(tool);
        parts.object_index = static_cast<std::uint32_t>(object);
        parts.rules = &rules_;
        parts.tool = &tools_[tool];
        parts.object = &objects_[object];
        parts.pose = &poses_[object];
        parts.model = {model, &*models_[model.value]};
        if (const auto* mesh = std::get_if<MeshCore>(&tools_[tool].spec().core); mesh != nullptr)
        {
            parts.tool_model = {mesh->model, &*models_[mesh->model.value]};
        }
        pairs_[i] = Pair(parts, memory, i);
    }
}

FrameOutput Frame::run(std::span<const ToolState> tools, std::span<const ObjectPose> poses,
                       const Budgets& budgets, StageMark mark) noexcept
{
    ++frame_;
    work_ = WorkCounters{};
    faults_ = FrameFault::none;
    budgets_ = budgets;
    begin(tools, poses);
    load(budgets);
    mark(Stage::load);
    refine(budgets);
    mark(Stage::refine);
    refit();
    mark(Stage::refit);
    for (Pair& pair : pairs_)
    {
        pair.query(budgets, work_, faults_);
    }
    mark(Stage::query);
    respond();
    const FrameOutput output = report();
    mark(Stage::force);
    return output;
}

void Frame::rehearse() noexcept
{
    for (const Pair& pair : pairs_)
    {
        pair.rehearse(budgets_, *rehearsed_);
    }
}

/// Places tools and pairs, before anything is asked where they are.
void Frame::begin(std::span<const ToolState> tools, std::span<const ObjectPose> poses) noexcept
{
    TACTUS_ASSERT(tools.size() == tools_.size());
    TACTUS_ASSERT(poses.size() == objects_.size());
    const double period_s = static_cast<double>(rules_.period_ns) * 1e-9;
    last_poses_ = poses_;
    for (std::size_t i = 0; i < poses.size(); ++i)
    {
        const Model& model = *models_[objects_[i].model.value];
        poses_[i] = model_pose(poses[i], model.header.origin_m());
    }
    const std::span<const ObjectPose> before{last_poses_.data(), has_poses_ ? poses.size() : 0};
    for (std::size_t i = 0; i < tools.size(); ++i)
    {
        faults_ |= tools_[i].begin(tools[i], period_s, before, {poses_.data(), poses.size()});
    }
    has_poses_ = true;
    for (Pair& pair : pairs_)
    {
        pair.place(budgets_, faults_);
    }
}

/// Adopt, predict, request.
void Frame::load(const Budgets& budgets) noexcept
{
    RegionRanking ranking;
    for (Pair& pair : pairs_)
    {
        pair.rank(ranking);
    }
    faults_ |= ranking.lacks_present ? FrameFault::ranking_full : FrameFault::none;
    for (std::uint32_t i = 0; i < model_count_; ++i)
    {
        door_takes_[i] = models_[i]->load(ModelId{i}, ranking, budgets, frame_, faults_);
    }
}

/// Coarsen, refine.
void Frame::refine(const Budgets& budgets) noexcept
{
    for (std::uint32_t i = 0; i < model_count_; ++i)
    {
        questions_.clear();
        for (Pair& pair : pairs_)
        {
            pair.ask(ModelId{i}, questions_);
        }
        models_[i]->refine(questions_.view(), budgets, frame_, faults_);
        if (has_meshes_)
        {
            models_[i]->refit(faults_); // The next model may ask how near its surface is.
        }
    }
}

void Frame::refit() noexcept
{
    for (std::uint32_t i = 0; i < model_count_; ++i)
    {
        if (!rules_.variant.refits_changed_only)
        {
            models_[i]->tree.mark_all();
        }
        models_[i]->refit(faults_);
    }
}

void Frame::respond() noexcept
{
    for (std::size_t i = 0; i < tools_.size(); ++i)
    {
        StaticVector<PlacedSurface, kMaxObjects> near;
        for (const Pair& pair : pairs_.subspan(i * objects_.size(), objects_.size()))
        {
            near.push_back(pair.placed());
        }
        const ToolOutput& output = tool_outputs_[i] = tools_[i].respond(near.view());
        faults_ |= frame_faults(output);
    }
}

FrameOutput Frame::report() noexcept
{
    for (std::size_t i = 0; i < pairs_.size(); ++i)
    {
        pair_outputs_[i] = pairs_[i].output();
    }
    for (std::uint32_t i = 0; i < model_count_; ++i)
    {
        validate(*models_[i]);
        model_outputs_[i] = models_[i]->output();
        work_ += models_[i]->work;
    }
    return {{tool_outputs_.data(), tools_.size()},
            {pair_outputs_.data(), pairs_.size()},
            {model_outputs_.data(), model_count_},
            work_,
            faults_,
            {door_takes_.data(), model_count_}};
}

} // namespace tactus
