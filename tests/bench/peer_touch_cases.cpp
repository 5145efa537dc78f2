// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// One sphere against one mesh, by every contestant in turn; only one of them is in memory at a
/// time.

#include "rt_core/math/infinity.hpp"
#include "tests/bench/frame_replay.hpp"
#include "tests/bench/judged_queries.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/peer_cases.hpp"
#include "tests/bench/static_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace tactus::bench
{

namespace
{

constexpr double kNear_diag = 2.0 * kRadius_diag;
/// Tolerance for contestants that use float on coordinates of about a diagonal.
constexpr double kTouchTolerance_diag = 2e-6;
/// Speed limit of the streaming tool: 1.5 times the flight's speed.
constexpr double kFastest_diag_per_s = 3.0;
constexpr const char* kStreaming = "Tactus streaming";

/// Questions about one scene, and the first contestant's times, to which the others are compared.
struct TouchTrial
{
    const CaseContext& context;
    const PeerTouchCase& test_case;
    const Scene& scene;
    std::uint32_t passes;
    Questions questions;
    std::vector<bool> is_near;
    std::vector<bool> is_flight;
    double our_p99_us{0.0};

    [[nodiscard]] double diagonal_m() const { return scene.model.diagonal_m; }
    [[nodiscard]] double band_m() const { return kNear_diag * diagonal_m(); }
    [[nodiscard]] double radius_m() const { return kRadius_diag * diagonal_m(); }
    /// Bands of the questions; infinite in flight, unless the contestant requires one.
    [[nodiscard]] std::vector<double> bands_m(bool in_flight_too) const
    {
        std::vector<double> bands;
        std::ranges::transform(is_near, std::back_inserter(bands),
                               [&](bool near)
                               { return near || in_flight_too ? band_m() : kInfinity; });
        return bands;
    }
};

TouchTrial make_trial(const CaseContext& context, const PeerTouchCase& test_case,
                      const Scene& scene)
{
    TouchTrial trial{context, test_case, scene, context.options.passes_or(5, 3), {}, {}, {}};
    const std::uint32_t frames = context.options.frames_or(4 * kCycleFrames, kCycleFrames);
    trial.questions = ask(scene, touch_motion(scene.touch(), frames));
    trial.is_near = trial.questions.nearer_than(trial.band_m());
    trial.is_flight = trial.is_near;
    trial.is_flight.flip();
    return trial;
}

CaseRows rows_of(const TouchTrial& trial, const std::string& by, std::uint64_t hash)
{
    Row common = trial.context.common_row(trial.scene.model.name, trial.test_case.part);
    common.by = by;
    common.setting = trial.test_case.setting;
    common.frames = trial.is_near.size();
    common.hash = hash;
    return {trial.context.rows, common};
}

/// Adds times; flight only of contestants without a band there.
void add_times(const TouchTrial& trial, CaseRows& rows, const std::vector<double>& times_us,
               bool is_banded)
{
    const Spread near = spread_of(chosen(times_us, trial.is_near));
    rows.add("near p50", near.p50, "us");
    rows.add("near p99", near.p99, "us");
    rows.add("near max", near.max, "us");
    rows.add("p99 to Tactus static", near.p99 / trial.our_p99_us, "x");
    if (!is_banded)
    {
        rows.add("flight p99", quantile(chosen(times_us, trial.is_flight), 0.99), "us");
    }
}

void add_touch_errors(const TouchTrial& trial, CaseRows& rows, const std::string& by,
                      std::span<const double> told_m)
{
    const TouchErrors errors = judge_touch(told_m, trial.questions.truth_m, trial.radius_m(),
                                           kTouchTolerance_diag * trial.diagonal_m());
    rows.add("missed", static_cast<double>(errors.missed), "", our_goal(by, 0.0));
    rows.add("invented", static_cast<double>(errors.invented), "", our_goal(by, 0.0));
}

void add_allocations(CaseRows& rows, const std::string& by, std::optional<std::uint64_t> count,
                     std::size_t queries)
{
    if (count)
    {
        rows.add("allocations a query", static_cast<double>(*count) / static_cast<double>(queries),
                 "calls", our_goal(by, 0.0));
    }
}

void add_cost(const TouchTrial& trial, CaseRows& rows, double build_ms, double bytes)
{
    rows.add("build", build_ms, "ms");
    rows.add("memory", bytes / static_cast<double>(trial.scene.model.faces.size()), "B a face");
}

void add_contestant(TouchTrial& trial, const std::string& by, const BuiltQuery& built)
{
    const bool is_banded = built.query->needs_band();
    const std::vector<double> bands_m = trial.bands_m(is_banded);
    const auto replayed =
        replay_queries(*built.query, trial.questions.points_m, bands_m, trial.passes);
    const PointAnswers& told = replayed;
    const std::vector<double>& times_us = told.us.least();
    if (trial.our_p99_us == 0.0)
    {
        trial.our_p99_us = quantile(chosen(times_us, trial.is_near), 0.99);
    }
    const double error_m = largest_error_m(told.distances_m, trial.questions.truth_m, bands_m);
    const double point_error_m = largest_point_error_m(told, trial.questions, *trial.scene.tree);
    CaseRows rows = rows_of(trial, by, told.hash);
    add_times(trial, rows, times_us, is_banded);
    rows.add("distance off", error_m / trial.diagonal_m(), "diag", our_goal(by, kOurError_diag));
    rows.add("nearest point off", point_error_m / trial.diagonal_m(), "diag",
             our_goal(by, kOurError_diag));
    add_touch_errors(trial, rows, by, told.distances_m);
    add_allocations(rows, by, told.allocations, times_us.size());
    add_cost(trial, rows, built.build_ms, built.bytes);
}

/// Adds the static model. Its construction is that of a controller from an encoded model: load,
/// link, refine and refit; the encoder's own time is not included.
void add_static_model(TouchTrial& trial)
{
    const BenchClock::time_point start = BenchClock::now();
    StaticModel model(trial.scene);
    const double build_ms = 1e3 * seconds(start, BenchClock::now());
    const BuiltQuery built{std::make_unique<TactusQuery>(model.tree()), build_ms,
                           static_cast<double>(model.bytes())};
    return add_contestant(trial, "Tactus static", built);
}

void add_peers(TouchTrial& trial)
{
    for (const PointPeer& peer : point_peers())
    {
        if (trial.scene.model.faces.size() > peer.most_faces)
        {
            fmt::print(stderr, "{}: left out, {} faces: {}\n", peer.name,
                       trial.scene.model.faces.size(), peer.why_no_more);
            continue;
        }
        const auto built = build_peer(peer, trial.scene.model.faces, trial.radius_m());
        add_contestant(trial, peer.name, built);
    }
}

/// Distance by which a frame reports touch: the distance if exact, infinity if separated, and the
/// least known distance otherwise.
double told_distance_m(const PairOutput& answer)
{
    return answer.kind == AnswerKind::separated ? kInfinity : answer.upper_m;
}

FrameRun make_streaming_run(const TouchTrial& trial, std::size_t pool_bytes)
{
    FrameRun run{trial.scene, trial.questions.points_m, 0, {}, {}};
    ToolSpec tool;
    tool.radius_m = trial.radius_m();
    tool.speed_max_m_per_s = kFastest_diag_per_s * trial.diagonal_m();
    tool.query_only = true; // The answers are for the motion's own points.
    run.rig.tools = {tool};
    run.rig.pool_bytes = pool_bytes;
    return run;
}

/// Adds the greatest error of exact answers, and the frames without one in which the sphere may
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
            error_m = std::max(error_m, std::abs(answer.upper_m - trial.questions.truth_m[i]));
        }
        open += answer.kind == AnswerKind::exact || answer.kind == AnswerKind::separated ? 0U : 1U;
    }
    rows.add("distance off", error_m / trial.diagonal_m(), "diag",
             our_goal(kStreaming, kOurError_diag));
    add_touch_errors(trial, rows, kStreaming, told_m);
    rows.add("open frames", static_cast<double>(open), "");
}

/// Adds T_L + T_R + T_B + T_Q of a frame that streams into small pools.
void add_streaming(const TouchTrial& trial, std::size_t pool_bytes)
{
    const FrameRun run = make_streaming_run(trial, pool_bytes);
    FrameReplay replay(run);
    replay.run(trial.passes);
    CaseRows rows = rows_of(trial, kStreaming, replay.hash());
    add_times(trial, rows, replay.sum_us(CacheState::warm).least(), false);
    add_frame_answers(trial, rows, replay);
    add_allocations(rows, kStreaming, replay.allocations(), run.counted());
    const double faces = static_cast<double>(trial.scene.model.faces.size());
    rows.add("memory", static_cast<double>(pool_bytes) / faces, "B a face");
}

} // namespace

void run_peer_touch_case(const CaseContext& context, const PeerTouchCase& test_case)
{
    const Scene& scene = context.scenes.get(test_case.scene);
    const PinnedCore pinned(context.options.core);
    TouchTrial trial = make_trial(context, test_case, scene);
    add_static_model(trial);
    if (test_case.pool_bytes)
    {
        add_streaming(trial, *test_case.pool_bytes);
    }
    return add_peers(trial);
}

} // namespace tactus::bench
