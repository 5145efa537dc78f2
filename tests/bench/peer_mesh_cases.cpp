// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// A mesh tool against one mesh, by every contestant in turn.

#include "tests/bench/measuring.hpp"
#include "tests/bench/mesh_touch.hpp"
#include "tests/bench/pair_trial.hpp"
#include "tests/bench/peer_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace tactus::bench
{

namespace
{

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

} // namespace

void run_peer_mesh_case(const CaseContext& context, const PeerMeshCase& test_case)
{
    const Scene& scene = context.scenes.get(test_case.scene);
    const PinnedCore pinned(context.options.core);
    for (const MeshProbe probe : {MeshProbe::large, MeshProbe::small})
    {
        run_probe(context, scene, probe);
    }
}

} // namespace tactus::bench
