// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// One probe against one mesh, by every contestant in turn: only one of them is in memory.

#include "tests/bench/frame_replay.hpp"
#include "tests/bench/judged_queries.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/peer_cases.hpp"
#include "tests/bench/static_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>

namespace tactus::bench
{

namespace
{

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNear_diag = 2.0 * kRadius_diag;
/// Some contestants work in float on coordinates of about a diagonal; that is no miss.
constexpr double kTouchTolerance_diag = 2e-6;
/// The streaming tool may move this fast: the flight's speed and half as much again.
constexpr double kFastest_diag_per_s = 3.0;

/// The questions of one scene and what every contestant is told of them.
struct TouchTrial
{
    const CaseContext& context;
    const char* part;
    const Scene& scene;
    std::string setting;
    std::uint32_t passes;
    Questions all;
    std::vector<bool> is_near;
    Questions near;
    Questions flight; ///< The others; none: not asked.
    double our_p99_us{0.0};

    [[nodiscard]] double diagonal_m() const { return scene.model.diagonal_m; }
    [[nodiscard]] double band_m() const { return kNear_diag * diagonal_m(); }
    [[nodiscard]] double radius_m() const { return kRadius_diag * diagonal_m(); }
    [[nodiscard]] TouchErrors judge(std::span<const double> answers_m,
                                    std::span<const double> truth_m) const
    {
        return judge_touch(answers_m, truth_m, radius_m(), kTouchTolerance_diag * diagonal_m());
    }
};

TouchTrial make_trial(const CaseContext& context, const char* part, const Scene& scene)
{
    TouchTrial trial{context, part, scene, "", context.options.passes_or(5, 3), {}, {}, {}, {}};
    const std::uint32_t frames = context.options.frames_or(4 * kCycleFrames, kCycleFrames);
    trial.all = ask(scene, touch_motion(scene.touch(), frames));
    trial.is_near = trial.all.nearer_than(trial.band_m());
    trial.near = chosen(trial.all, trial.is_near);
    return trial;
}

CaseRows rows_of(const TouchTrial& trial, const std::string& by, std::uint64_t hash)
{
    Row common = trial.context.common_row(trial.scene.model.name, trial.part);
    common.by = by;
    common.setting = trial.setting;
    common.frames = trial.near.points_m.size() + trial.flight.points_m.size();
    common.hash = hash;
    return {trial.context.rows, common};
}

void add_times(const TouchTrial& trial, CaseRows& rows, const Spread& near)
{
    rows.add("near p50", near.p50, "us");
    rows.add("near p99", near.p99, "us");
    rows.add("near max", near.max, "us");
    rows.add("p99 to Tactus static", near.p99 / trial.our_p99_us, "x");
}

void add_errors(CaseRows& rows, const TouchErrors& errors)
{
    rows.add("missed", static_cast<double>(errors.missed), "");
    rows.add("invented", static_cast<double>(errors.invented), "");
}

void add_allocations(CaseRows& rows, const std::optional<std::uint64_t>& count, std::size_t queries)
{
    if (count)
    {
        rows.add("allocations a query", static_cast<double>(*count) / static_cast<double>(queries),
                 "calls");
    }
}

void add_cost(const TouchTrial& trial, CaseRows& rows, double build_ms, double bytes)
{
    rows.add("build", build_ms, "ms");
    rows.add("memory", bytes / static_cast<double>(trial.scene.model.faces.size()), "B a face");
}

/// All rows of one contestant whose structure is built. Its near p99 becomes ours when it is the
/// first.
CaseFailure add_contestant(TouchTrial& trial, const std::string& by, const BuiltQuery& built)
{
    TouchQuery& query = *built.query;
    const auto near = replay_queries(query, trial.near, trial.band_m(), trial.passes);
    if (!near)
    {
        return near.error().text;
    }
    const bool flies = !trial.flight.points_m.empty() && !query.needs_band();
    const auto flight =
        replay_queries(query, flies ? trial.flight : Questions{}, kInfinity, trial.passes);
    if (!flight)
    {
        return flight.error().text;
    }
    const PointAnswers& told = near.value();
    const PointAnswers& told_far = flight.value();
    const Spread times_us = spread_of(told.us.least());
    trial.our_p99_us = trial.our_p99_us > 0.0 ? trial.our_p99_us : times_us.p99;
    CaseRows rows = rows_of(trial, by, told.hash + 3 * told_far.hash);
    add_times(trial, rows, times_us);
    if (flies)
    {
        rows.add("flight p99", spread_of(told_far.us.least()).p99, "us");
    }
    const double error_m =
        std::max(largest_error_m(told.distances_m, trial.near.truth_m, trial.band_m()),
                 largest_error_m(told_far.distances_m, trial.flight.truth_m, kInfinity));
    rows.add("distance off", error_m / trial.diagonal_m(), "diag");
    rows.add("nearest point off",
             largest_point_error_m(told, trial.near, *trial.scene.tree) / trial.diagonal_m(),
             "diag");
    TouchErrors errors = trial.judge(told.distances_m, trial.near.truth_m);
    errors += trial.judge(told_far.distances_m, trial.flight.truth_m);
    add_errors(rows, errors);
    add_allocations(rows, told.allocations, told.distances_m.size());
    add_cost(trial, rows, built.build_ms, built.bytes);
    return std::nullopt;
}

/// Its build is what a controller does with an encoded model: load, link, refine and refit. That
/// of the model is the encoder's, once, beforehand.
CaseFailure add_static_model(TouchTrial& trial)
{
    const BenchClock::time_point start = BenchClock::now();
    auto model = StaticModel::make(trial.scene);
    if (!model)
    {
        return model.error().text;
    }
    const double build_ms = 1e3 * seconds(start, BenchClock::now());
    const BuiltQuery built{std::make_unique<TactusQuery>(model.value()->tree()), build_ms,
                           static_cast<double>(model.value()->bytes())};
    return add_contestant(trial, "Tactus static", built);
}

CaseFailure add_peers(TouchTrial& trial)
{
    for (const PointPeer& peer : point_peers())
    {
        if (trial.scene.model.faces.size() > peer.most_faces)
        {
            fmt::print(stderr, "{}: left out, {} faces would take it minutes\n", peer.name,
                       trial.scene.model.faces.size());
            continue;
        }
        const auto built = build_peer(peer, trial.scene.model.faces, trial.radius_m());
        if (!built)
        {
            return built.error().text;
        }
        if (auto failure = add_contestant(trial, peer.name, built.value()))
        {
            return failure;
        }
    }
    return std::nullopt;
}

/// What a frame says of touch: the distance where it is exact, nothing in reach where that is
/// decided, and the least that is known where the question is open.
double told_distance_m(const PairOutput& answer)
{
    return answer.kind == AnswerKind::decided ? kInfinity : answer.upper_m;
}

FrameRun make_streaming_run(const TouchTrial& trial, std::size_t pool_bytes)
{
    FrameRun run{trial.scene, trial.all.points_m, 0, {}, {}};
    ToolSpec tool;
    tool.radius_m = trial.radius_m();
    tool.speed_max_m_per_s = kFastest_diag_per_s * trial.diagonal_m();
    tool.passes_through = true; // Answers are of the motion's own points.
    run.rig.tools = {tool};
    run.rig.pool_bytes = pool_bytes;
    return run;
}

/// How far exact answers are off at most, and the frames that have none in which the probe may
/// touch.
void add_frame_answers(const TouchTrial& trial, CaseRows& rows, const FrameReplay& replay)
{
    std::vector<double> told_m;
    double error_m = 0.0;
    std::uint64_t open = 0;
    for (std::size_t i = 0; i < replay.answers().size(); ++i)
    {
        const PairOutput& answer = replay.answers()[i];
        told_m.push_back(told_distance_m(answer));
        if (answer.kind == AnswerKind::exact)
        {
            error_m = std::max(error_m, std::abs(answer.upper_m - trial.all.truth_m[i]));
        }
        open += answer.kind == AnswerKind::exact || answer.kind == AnswerKind::decided ? 0U : 1U;
    }
    rows.add("distance off", error_m / trial.diagonal_m(), "diag");
    add_errors(rows, trial.judge(told_m, trial.all.truth_m));
    rows.add("open frames", static_cast<double>(open), "");
}

/// T_R + T_B + T_Q of a frame that streams into small pools.
CaseFailure add_streaming(const TouchTrial& trial, std::size_t pool_bytes)
{
    const FrameRun run = make_streaming_run(trial, pool_bytes);
    FrameReplay replay(run);
    for (std::uint32_t pass = 0; pass < trial.passes; ++pass)
    {
        if (auto failure = replay.run_once(CacheState::warm, run.counted()))
        {
            return failure;
        }
    }
    const std::vector<double>& times_us = replay.sum_us(CacheState::warm).least();
    std::vector<bool> is_far = trial.is_near;
    is_far.flip();
    CaseRows rows = rows_of(trial, "Tactus streaming", replay.hash());
    add_times(trial, rows, spread_of(chosen(times_us, trial.is_near)));
    rows.add("flight p99", spread_of(chosen(times_us, is_far)).p99, "us");
    add_frame_answers(trial, rows, replay);
    add_allocations(rows, replay.allocations(), run.counted());
    const double faces = static_cast<double>(trial.scene.model.faces.size());
    rows.add("memory", static_cast<double>(pool_bytes) / faces, "B a face");
    return std::nullopt;
}

} // namespace

CaseFailure run_peer_touch_case(const CaseContext& context, const PeerTouchCase& test_case)
{
    const auto scene = context.scenes.get(test_case.scene);
    if (!scene)
    {
        return scene.error().text;
    }
    const PinnedCore pinned(context.options.core);
    TouchTrial trial = make_trial(context, "W1, touch", *scene.value());
    std::vector<bool> is_far = trial.is_near;
    is_far.flip();
    trial.flight = chosen(trial.all, is_far);
    if (auto failure = add_static_model(trial))
    {
        return failure;
    }
    if (auto failure = add_streaming(trial, test_case.pool_bytes))
    {
        return failure;
    }
    return add_peers(trial);
}

CaseFailure run_peer_scale_case(const CaseContext& context, const PeerScaleCase& test_case)
{
    const auto scene = context.scenes.get(test_case.scene);
    if (!scene)
    {
        return scene.error().text;
    }
    const PinnedCore pinned(context.options.core);
    TouchTrial trial = make_trial(context, "W3, scale", *scene.value());
    trial.setting = test_case.setting;
    if (auto failure = add_static_model(trial))
    {
        return failure;
    }
    return add_peers(trial);
}

} // namespace tactus::bench
