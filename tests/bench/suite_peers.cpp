// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Suite `peers`: the same work for our queries and for those of alternative libraries. Without
/// peers in the build, ours alone.

#include "rt_core/math/infinity.hpp"
#include "tests/bench/cases.hpp"
#include "tests/bench/frame_replay.hpp"
#include "tests/bench/judged_queries.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/mesh_touch.hpp"
#include "tests/bench/static_model.hpp"
#include "tests/bench/suites.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace tactus::bench
{
namespace
{

// Goals of our own answers, not of the peers': exact to rounding, no touch missed or invented, no
// heap call.

std::optional<double> our_goal(const std::string& by, double goal)
{
    return by.starts_with("Tactus") ? std::optional(goal) : std::nullopt;
}

/// One sphere in the touching motion, for every contestant.
struct PeerTouchCase
{
    const char* part;
    SceneSource scene;
    const char* setting;
    /// Pools of the streaming contestant; empty: there is none.
    std::optional<std::size_t> pool_bytes;
};

struct PeerMeshCase
{
    SceneSource scene;
};

// One sphere against one mesh, by every contestant in turn; only one of them is in memory at a
// time.

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

/// Workloads W1 and W3: near frames with a band of two radii, flight without one, errors about
/// touch, and cost of construction and memory.
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

// A mesh tool against one mesh, by every contestant in turn.

/// Distance below which meshes are near, as a share of the diagonal.
constexpr double kNearMeshes_diag = 0.02;

/// Frames by their result.
enum class PairClass : std::uint8_t
{
    all,
    contact, ///< Some faces meet.
    near,
    far,
};
constexpr std::array kPairClasses{PairClass::all, PairClass::contact, PairClass::near,
                                  PairClass::far};

/// Prefix of the names of its figures.
std::string prefix_of(PairClass of)
{
    switch (of)
    {
    case PairClass::contact:
        return "contact ";
    case PairClass::near:
        return "near ";
    case PairClass::far:
        return "far ";
    case PairClass::all:
        break;
    }
    return "";
}

/// Last commit before faces were decided and bounded in single precision.
constexpr const char* kCommitBefore = "9e4f313";

/// Greatest value of a figure of ours: a share of FCL's or of that at kCommitBefore, or
/// microseconds.
struct PairGoal
{
    const char* scene;
    MeshProbe probe;
    PairQuestion question;
    PairClass of;
    const char* figure;
    double goal;
    double before_us{0.0}; ///< Value at kCommitBefore when the goals were set, from a separate run.
};
constexpr const char* kFineScene = kFineBunny.name;
constexpr std::array kPairGoals{
    PairGoal{kBunny.name, MeshProbe::large, PairQuestion::any, PairClass::all, "p50 to FCL", 0.011},
    PairGoal{kBunny.name, MeshProbe::large, PairQuestion::all_pairs, PairClass::contact,
             "p50 to FCL", 0.075},
    PairGoal{kBunny.name, MeshProbe::large, PairQuestion::distance, PairClass::near, "p50 to FCL",
             0.08},
    PairGoal{kBunny.name, MeshProbe::small, PairQuestion::all_pairs, PairClass::contact,
             "p50 to FCL", 0.14},
    PairGoal{kBunny.name, MeshProbe::small, PairQuestion::distance, PairClass::far, "p99", 200.0},
    PairGoal{kBunny.name, MeshProbe::large, PairQuestion::contacts, PairClass::contact, "p50",
             50.0},
    PairGoal{kBunny.name, MeshProbe::large, PairQuestion::contacts, PairClass::contact, "p99",
             90.0},
    PairGoal{kFineScene, MeshProbe::large, PairQuestion::all_pairs, PairClass::contact, "p50", 0.3,
             454.0},
    PairGoal{kFineScene, MeshProbe::large, PairQuestion::any, PairClass::near, "p99", 0.3, 174.0},
};

/// One probe over one scene, with the questions to every contestant.
struct MeshTrial
{
    const CaseContext& context;
    const Scene& object;
    MeshProbe probe;
    std::uint32_t passes;
    std::vector<Similarity> places;
    PairTruth truth;
};

/// Figures by question and class.
using PairSpreads = std::map<std::pair<PairQuestion, PairClass>, Spread>;

std::vector<bool> frames_of(const MeshTrial& trial, PairClass of)
{
    std::vector<bool> frames;
    for (const double distance_m : trial.truth.distances_m)
    {
        const PairClass is = distance_m == 0.0 ? PairClass::contact
                             : distance_m < kNearMeshes_diag * trial.object.model.diagonal_m
                                 ? PairClass::near
                                 : PairClass::far;
        frames.push_back(of == PairClass::all || of == is);
    }
    return frames;
}

CaseRows rows_of(const MeshTrial& trial, const std::string& by, const char* setting,
                 std::uint64_t hash)
{
    Row common = trial.context.common_row(trial.object.model.name, trial.probe == MeshProbe::large
                                                                       ? "W2, mesh tool"
                                                                       : "W2, small mesh tool");
    common.by = by;
    common.setting = setting;
    common.frames = trial.places.size();
    common.hash = hash;
    return {trial.context.rows, common};
}

/// Goal of a figure; null if it has none.
const PairGoal* goal_of(const MeshTrial& trial, PairQuestion question, PairClass of,
                        const std::string& figure)
{
    const auto* const found = std::ranges::find_if(
        kPairGoals,
        [&](const PairGoal& wanted)
        {
            return trial.object.model.name == wanted.scene && wanted.probe == trial.probe &&
                   wanted.question == question && wanted.of == of && figure == wanted.figure;
        });
    return found == kPairGoals.end() ? nullptr : found;
}

/// Adds a time of ours with its goal.
void add_own_time(CaseRows& rows, const std::string& metric, double us, const PairGoal* goal)
{
    if (goal == nullptr || goal->before_us == 0.0)
    {
        rows.add(metric, us, "us", goal == nullptr ? std::nullopt : std::optional(goal->goal));
        return;
    }
    rows.add(metric, us, "us");
    Row& row = rows.add(fmt::format("{} to {}", metric, kCommitBefore), us / goal->before_us, "",
                        goal->goal);
    row.peer = kCommitBefore;
    row.peer_value = goal->before_us;
}

/// Adds the times of each class that has frames.
void add_times(const MeshTrial& trial, const std::string& name, CaseRows& rows,
               const PairAnswers& answers, PairQuestion question, PairSpreads& spreads)
{
    for (const PairClass of : kPairClasses)
    {
        const std::vector<double> times_us = chosen(answers.us.least(), frames_of(trial, of));
        if (times_us.empty())
        {
            continue;
        }
        const Spread spread_us = spread_of(times_us);
        for (const auto& [figure, us] : {std::pair("p50", spread_us.p50), {"p99", spread_us.p99}})
        {
            const bool is_ours = our_goal(name, 0.0).has_value();
            add_own_time(rows, prefix_of(of) + figure, us,
                         is_ours ? goal_of(trial, question, of, figure) : nullptr);
        }
        rows.add(prefix_of(of) + "max", spread_us.max, "us");
        spreads[{question, of}] = spread_us;
    }
}

void add_contestant(const MeshTrial& trial, PairQuery& query, PairSpreads& spreads)
{
    for (const PairQuestion question : kPairQuestions)
    {
        const auto answers = replay_pairs(query, trial.places, question, trial.passes);
        CaseRows rows = rows_of(trial, query.name(), question_name(question), answers.hash);
        add_times(trial, query.name(), rows, answers, question, spreads);
        const PairErrors errors = judge_pairs(answers, trial.truth, question);
        if (question == PairQuestion::distance)
        {
            rows.add("off", errors.largest_m / trial.object.model.diagonal_m, "diag",
                     our_goal(query.name(), kOurError_diag));
            continue;
        }
        rows.add("missed", static_cast<double>(errors.missed), "", our_goal(query.name(), 0.0));
        rows.add("invented", static_cast<double>(errors.invented), "", our_goal(query.name(), 0.0));
    }
}

/// Adds the true numbers of meeting frames and pairs.
void add_truth(const MeshTrial& trial)
{
    std::size_t meet = 0;
    std::size_t pairs = 0;
    std::size_t most = 0;
    for (const auto& meeting : trial.truth.meeting)
    {
        meet += meeting.empty() ? 0U : 1U;
        pairs += meeting.size();
        most = std::max(most, meeting.size());
    }
    CaseRows rows = rows_of(trial, "truth", "", pairs);
    for (const PairClass of : kPairClasses)
    {
        rows.add(prefix_of(of) + "frames",
                 static_cast<double>(std::ranges::count(frames_of(trial, of), true)), "");
    }
    rows.add("pairs a frame that meets",
             static_cast<double>(pairs) / static_cast<double>(std::max<std::size_t>(meet, 1)), "");
    rows.add("pairs at most", static_cast<double>(most), "");
}

/// Adds our times as shares of another contestant's from the same run.
void add_shares(const MeshTrial& trial, const std::string& own, const std::string& other,
                const PairSpreads& ours_us, const PairSpreads& others_us)
{
    for (const auto& [of, other_us] : others_us)
    {
        const auto& [question, frames] = of;
        CaseRows rows = rows_of(trial, own, question_name(question), 0);
        const Spread& own_us = ours_us.at(of);
        for (const auto& [figure, share] : {std::pair("p50 to ", own_us.p50 / other_us.p50),
                                            {"p99 to ", own_us.p99 / other_us.p99}})
        {
            const PairGoal* goal = goal_of(trial, question, frames, figure + other);
            rows.add(prefix_of(frames) + figure + other, share, "",
                     goal == nullptr ? std::nullopt : std::optional(goal->goal));
        }
    }
}

void run_probe(const CaseContext& context, const Scene& object, MeshProbe probe)
{
    const Scene& tool = context.scenes.get(make_tool_mesh(object, probe));
    const PairMeshes meshes{faces_in_source_frame(tool), faces_in_model_frame(object)};
    MeshTrial trial{context, object, probe, context.options.passes_or(5, 3), {}, {}};
    const std::uint32_t frames = probe == MeshProbe::small
                                     ? context.options.frames_or(kCycleFrames, kCycleFrames / 2)
                                     : context.options.frames_or(kTouchFrames, kTouchFrames / 3);
    trial.places = mesh_touch_motion(object.touch(), meshes.tool, probe, frames);
    trial.truth = find_pair_truth(tool, object, trial.places);
    add_truth(trial);
    TactusPairQuery ours(tool, object);
    PairSpreads ours_us;
    add_contestant(trial, ours, ours_us);
    for (const PairPeer& peer : context.options.count ? std::vector<PairPeer>() : pair_peers())
    {
        PairSpreads others_us;
        add_contestant(trial, *peer.make(meshes), others_us);
        add_shares(trial, ours.name(), peer.name, ours_us, others_us);
    }
}

/// Workload W2: a mesh tool rotates and slides through the surface.
void run_peer_mesh_case(const CaseContext& context, const PeerMeshCase& test_case)
{
    const Scene& scene = context.scenes.get(test_case.scene);
    const PinnedCore pinned(context.options.core);
    for (const MeshProbe probe : {MeshProbe::large, MeshProbe::small})
    {
        run_probe(context, scene, probe);
    }
}

std::vector<Case> peers_cases()
{
    const auto touch =
        [](const char* name, When when, const SceneSource& scene, std::size_t pool_bytes)
    {
        return make_case(name, when, run_peer_touch_case,
                         PeerTouchCase{"W1, touch", scene, "", pool_bytes});
    };
    const auto mesh = [](const char* name, When when, const SceneSource& scene)
    { return make_case(name, when, run_peer_mesh_case, PeerMeshCase{scene}); };
    const auto scale = [](const char* name, When when, std::uint32_t faces, const char* setting)
    {
        const SceneSource sphere{name, nullptr, 0, faces};
        return make_case(name, when, run_peer_touch_case,
                         PeerTouchCase{"W3, scale", sphere, setting, std::nullopt});
    };
    return {
        touch("touch-bunny", When::always, kBunny, 2 * kMiB),
        touch("touch-igea", When::full_only, kIgea, 4 * kMiB),
        mesh("mesh-bunny", When::always, kBunny),
        mesh("mesh-igea", When::full_only, kIgea),
        mesh("mesh-1.1M", When::full_only, kFineBunny),
        scale("scale-4k", When::always, 4'000, "4 k faces"),
        scale("scale-40k", When::always, 40'000, "40 k faces"),
        scale("scale-400k", When::full_only, 400'000, "400 k faces"),
        scale("scale-4M", When::full_only, 4'000'000, "4 M faces"),
        touch("touch-tiny", When::named_only, kTiny, kMiB),
        mesh("mesh-tiny", When::named_only, kTiny),
        scale("scale-tiny", When::named_only, 2'000, "2 k faces"),
    };
}

} // namespace

Suite peers_suite()
{
    return {"peers", peers_cases};
}

} // namespace tactus::bench
