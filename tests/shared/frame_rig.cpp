// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

#include "tests/shared/frame_rig.hpp"

#include "rt_core/frame/validate_model.hpp"
#include "transport/pool_plan.hpp"

#include <cstdio>
#include <cstdlib>

namespace tactus::test
{

void RigRecorder::follow(ChunkLoader& chunk_loader)
{
    for (std::uint32_t model = 0; model < chunk_loader.model_count(); ++model)
    {
        lines_.push_back(std::make_unique<Line>(writer_, model));
        chunk_loader.copy_pieces_to(lines_.back().get(), model);
    }
}

void RigRecorder::add(const FrameInput& input, const FrameOutput& output)
{
    writer_.add_frame(encoder_.encode(input, output));
}

std::vector<std::byte> RigRecorder::finish()
{
    writer_.finish(kNoFrame);
    return writer_.take_bytes();
}

namespace
{

[[noreturn]] void give_up(const std::string& reason)
{
    std::fprintf(stderr, "frame rig: %s\n", reason.c_str());
    std::exit(2);
}

std::uint32_t validated_every = 0; ///< Frames between validations; 0: never.
/// Interval for fully refined models, which are the largest and no longer change: without it the
/// force twins of test_stability take thirty times as long.
constexpr std::uint32_t kCompleteEvery = 64;

} // namespace

void FrameRig::validate_every(std::uint32_t frames)
{
    validated_every = frames;
}

FrameRig::FrameRig(const std::vector<const TestModel*>& models, const RigOptions& options)
    : memory_(options.pool_bytes)
    , chunk_loader_steps_(options.chunk_loader_steps_per_frame)
    , period_ns_(options.period_ns)
{
    serve(models, options.faults);
    arena_.emplace(memory_.span());
    const std::vector<ToolSpec> tools =
        options.tools.empty()
            ? std::vector<ToolSpec>{{0.01 * models[0]->diagonal_m, 500.0, 8.0, 1.0}}
            : options.tools;
    const std::vector<ObjectSpec> objects =
        options.objects.empty() ? std::vector{ObjectSpec{ModelId{0}}} : options.objects;
    FrameSetup setup;
    setup.tools = tools;
    setup.objects = objects;
    setup.capacities = options.capacities;
    std::vector<ObjectPose> source_poses;
    for (const ObjectSpec& object : objects)
    {
        const std::size_t i = source_poses.size();
        poses_.push_back(i < options.poses.size() ? options.poses[i] : ObjectPose{});
        shown_.push_back(object.model);
        source_poses.push_back(source_pose(poses_.back(), object.model));
    }
    setup.poses = source_poses;
    poses_.resize(capacities_of(setup).objects);
    shown_.resize(poses_.size(), ModelId{0});
    setup.period_ns = options.period_ns;
    setup.static_when_it_fits = options.static_when_it_fits;
    setup.prediction = options.prediction;
    setup.force_tolerance_n = options.force_tolerance_n;
    setup.variant = options.variant;
    setup.for_streamed_models = options.for_streamed_models;
    const std::vector<ModelSource> sources = plan_pools(setup, options);
    setup.models = sources;
    if (const auto started = Frame::start(frame_, *arena_, setup); !started)
    {
        give_up(refusal_text(started.error()));
    }
    make_chunk_loader();
    tools_.reserve(tools.size());
    if (options.record)
    {
        recorder_ = std::make_unique<RigRecorder>(setup);
        recorder_->follow(*chunk_loader_);
    }
}

void FrameRig::serve(const std::vector<const TestModel*>& models, const LoopbackFaults& faults)
{
    LoopbackFaults own = faults;
    for (const TestModel* model : models)
    {
        auto served = serve_from_file(model->path, model->name, {});
        if (!served)
        {
            give_up(served.error().text);
        }
        Line& line = lines_.emplace_back();
        line.served = std::move(served).value();
        line.link = std::make_unique<LoopbackLink>(*line.served.link, own);
        ++own.seed;
    }
}

std::vector<ModelSource> FrameRig::plan_pools(const FrameSetup& setup,
                                              const RigOptions& options) const
{
    std::vector<ModelSource> sources;
    if (options.for_streamed_models.faces > 0)
    {
        for (const Line& line : lines_)
        {
            sources.push_back({line.served.header, {}, {}});
        }
        return sources;
    }
    std::vector<ModelHeader> headers;
    for (const Line& line : lines_)
    {
        headers.push_back(ModelHeader::parse(line.served.header).value());
    }
    std::vector<ModelCapacities> capacities(headers.size());
    for (const ObjectSpec& object : setup.objects)
    {
        capacities[object.model.value].edit_faces = options.edit_faces;
    }
    if (!try_plan_pools(setup, headers, options.pool_bytes, options.cache_bytes, capacities))
    {
        give_up("the pools are too small for " + lines_[0].served.name);
    }
    for (std::size_t i = 0; i < lines_.size(); ++i)
    {
        capacities[i].cache_off = options.cache_off;
        sources.push_back({lines_[i].served.header, lines_[i].served.base, capacities[i]});
    }
    return sources;
}

void FrameRig::make_chunk_loader()
{
    ModelPools& pools = frame_->pools();
    chunk_loader_.emplace(*arena_, pools.slots, pools.cache.queues, Log{});
    for (std::uint32_t i = 0; i < lines_.size(); ++i)
    {
        Model& model = frame_->model({i});
        Line& line = lines_[i];
        chunk_loader_->add(model.header, model.linker, *line.link, line.served.name);
    }
}

FrameOutput FrameRig::step(const std::vector<Vec3>& goals_m, const Budgets& budgets, StageMark mark)
{
    deliver();
    return step_without_delivery(goals_m, budgets, mark);
}

FrameOutput FrameRig::step(std::span<const ToolState> tools, const Budgets& budgets)
{
    deliver();
    return step_without_delivery(tools, budgets, {});
}

FrameOutput FrameRig::step_without_delivery(const std::vector<Vec3>& goals_m,
                                            const Budgets& budgets, StageMark mark)
{
    tools_.resize(goals_m.size());
    for (std::size_t i = 0; i < goals_m.size(); ++i)
    {
        tools_[i].position_m = goals_m[i];
    }
    return step_without_delivery(tools_, budgets, mark);
}

ObjectPose FrameRig::source_pose(const ObjectPose& pose, ModelId model) const
{
    const Vec3 origin_m = ModelHeader::parse(lines_[model.value].served.header).value().origin_m();
    ObjectPose source_pose = pose;
    source_pose.translation_m -= pose.scale * (pose.rotation * origin_m);
    return source_pose;
}

void FrameRig::place_object(const ObjectPose& pose, std::size_t object)
{
    const auto number = static_cast<std::uint32_t>(object);
    change({SceneChangeKind::object_moves, number, frame_->objects()[number].generation, {}, pose});
}

/// Changes that the frame will refuse are passed too.
void FrameRig::change(SceneChange change)
{
    const bool comes = change.kind == SceneChangeKind::object_comes;
    const bool is_placed = comes || change.kind == SceneChangeKind::object_moves;
    if (is_placed && change.number < shown_.size())
    {
        ModelId& shown = shown_[change.number];
        shown = comes && change.object.model.value < lines_.size() ? change.object.model : shown;
        change.pose = source_pose(change.pose, shown);
        poses_[change.number] = model_pose(change.pose, frame_->model(shown).header.origin_m());
    }
    changes_.push_back(change);
}

void FrameRig::edit(const SurfaceEdit& edit)
{
    SurfaceEdit& kept = edits_.emplace_back(edit);
    kept.removed = removed_.emplace_back(edit.removed.begin(), edit.removed.end());
    kept.added = added_.emplace_back(edit.added.begin(), edit.added.end());
}

FrameOutput FrameRig::step_without_delivery(std::span<const ToolState> tools,
                                            const Budgets& budgets, StageMark mark)
{
    const FrameInput given = input(tools, budgets);
    const FrameOutput output = frame_->run(given, mark);
    if (recorder_ != nullptr)
    {
        recorder_->add(given, output);
    }
    changes_.clear();
    edits_.clear();
    removed_.clear();
    added_.clear();
    validate();
    return output;
}

void FrameRig::validate()
{
    ++frames_;
    if (validated_every == 0 || frames_ % validated_every != 0)
    {
        return;
    }
    for (std::uint32_t i = 0; i < lines_.size(); ++i)
    {
        if (model({i}).residence == Residence::complete && frames_ % kCompleteEvery != 0)
        {
            continue;
        }
        if (const Flaw flaw = find_flaw(model({i})); !flaw.is_none())
        {
            give_up("frame " + std::to_string(frames_) + ", model " + lines_[i].served.name + ": " +
                    text_of(flaw).data());
        }
    }
}

void FrameRig::deliver()
{
    for (std::uint32_t i = 0; i < chunk_loader_steps_; ++i)
    {
        now_ns_ += period_ns_ / chunk_loader_steps_;
        chunk_loader_->step(now_ns_);
    }
}

std::uint32_t FrameRig::requests_under_way() const
{
    std::uint32_t sum = 0;
    for (std::uint32_t i = 0; i < frame_->model_count(); ++i)
    {
        sum += frame_->model(ModelId{i}).cache.requests_under_way();
    }
    return sum;
}

std::uint32_t FrameRig::settle(const Vec3& goal_m, const Budgets& budgets, std::uint32_t frames)
{
    for (std::uint32_t i = 0; i < frames; ++i)
    {
        const FrameOutput output = step(goal_m, budgets);
        const bool quiet = output.work.splits == 0 && output.work.requests == 0 &&
                           output.work.pages_adopted == 0 && requests_under_way() == 0 &&
                           output.faults == FrameFault::none;
        if (quiet && i > 10)
        {
            return i;
        }
    }
    return frames;
}

RigOptions with_room_for_all()
{
    RigOptions options;
    options.pool_bytes = std::size_t{64} << 20U;
    options.cache_bytes = std::size_t{16} << 20U;
    return options;
}

void load_region(FrameRig& rig, const RankedRegion& region)
{
    Model& model = rig.model(region.model);
    CachePool& cache = rig.frame().pools().cache;
    Budgets budgets;
    budgets.requests = 64;
    budgets.regions = 64;
    FrameFault faults = FrameFault::none;
    const std::uint32_t frames_a_round = model.header.counts().index_pages() / budgets.regions + 1;
    // Quiet means two rounds of the index and a rest: the first includes pages that arrived with
    // the last chunks; after a rest, unanswered requests are repeated.
    std::uint32_t quiet = 0;
    std::uint32_t frame = 1;
    for (; frame < 10'000 && quiet <= 2 * frames_a_round + IndexSearch::kRestFrames; ++frame)
    {
        WorkCounters work;
        cache.adopt_arrivals(1'000, ChunkCache::kFirstFrame + frame, work);
        model.cache.request_missing({&region, 1}, budgets, ChunkCache::kFirstFrame + frame, work,
                                    faults);
        rig.deliver();
        const bool is_quiet =
            work.requests == 0 && work.pages_adopted == 0 && model.cache.requests_under_way() == 0;
        quiet = is_quiet ? quiet + 1 : 0;
    }
    if (frame == 10'000 || (faults & FrameFault::cache_full) != FrameFault::none)
    {
        give_up("not every chunk came");
    }
    // Includes records that were linked after their page was handed over.
    const std::uint32_t chunks = model.header.counts().chunks();
    for (std::uint32_t round = 0; round <= chunks / kMaxLinkUpdatesPerFrame + 1; ++round)
    {
        WorkCounters work;
        rig.deliver();
        cache.adopt_arrivals(1'000, ChunkCache::kFirstFrame + 10'000, work);
    }
}

void load_everything(FrameRig& rig)
{
    load_region(rig, {ModelId{0}, Vec3(0.0, 0.0, 0.0), 1e3, 0});
    if (rig.model().pages.used() != rig.model().header.counts().chunks())
    {
        give_up("not every chunk came");
    }
}

std::vector<FaceId> faces_by_path(Model& model)
{
    std::vector<std::pair<std::uint32_t, std::uint32_t>> keyed;
    for (std::uint32_t i = 0; i < model.header.counts().base_faces; ++i)
    {
        keyed.emplace_back(model.slots.base.faces[i].bucket, i);
    }
    for (std::uint32_t i = 0; i < model.header.counts().records; ++i)
    {
        const VsplitRecord& record = model.pages.resident(RecordId{i});
        for (std::uint32_t side = 0; side < 2; ++side)
        {
            if (record.has_face(side))
            {
                keyed.emplace_back(record.bucket[side], record.star[side].value);
            }
        }
    }
    std::sort(keyed.begin(), keyed.end());
    std::vector<FaceId> faces;
    for (const auto& [bucket, face] : keyed)
    {
        faces.push_back(FaceId{face});
    }
    return faces;
}

} // namespace tactus::test
