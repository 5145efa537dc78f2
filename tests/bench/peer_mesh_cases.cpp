// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// A tool that is a mesh against one mesh, by every contestant in turn.

#include "tests/bench/measuring.hpp"
#include "tests/bench/mesh_touch.hpp"
#include "tests/bench/pair_trial.hpp"
#include "tests/bench/peer_cases.hpp"

#include <algorithm>

namespace tactus::bench
{

namespace
{

constexpr const char* kPart = "W2, mesh tool";

/// One scene and what every contestant is asked about it.
struct MeshTrial
{
    const CaseContext& context;
    const Scene& object;
    std::uint32_t passes;
    std::vector<Similarity> places;
    PairTruth truth;
};

CaseRows rows_of(const MeshTrial& trial, const std::string& by, const char* setting,
                 std::uint64_t hash)
{
    Row common = trial.context.common_row(trial.object.model.name, kPart);
    common.by = by;
    common.setting = setting;
    common.frames = trial.places.size();
    common.hash = hash;
    return {trial.context.rows, common};
}

void add_times(CaseRows& rows, const PairAnswers& answers)
{
    const Spread times_us = spread_of(answers.us.least());
    rows.add("p50", times_us.p50, "us");
    rows.add("p99", times_us.p99, "us");
    rows.add("max", times_us.max, "us");
}

/// The rows of one contestant.
CaseFailure add_contestant(const MeshTrial& trial, PairQuery& query)
{
    for (const PairQuestion question : kPairQuestions)
    {
        const auto answers = replay_pairs(query, trial.places, question, trial.passes);
        if (!answers)
        {
            return answers.error().text;
        }
        CaseRows rows = rows_of(trial, query.name(), question_name(question), answers.value().hash);
        add_times(rows, answers.value());
        const PairErrors errors = judge_pairs(answers.value(), trial.truth, question);
        if (question == PairQuestion::distance)
        {
            rows.add("off", errors.largest_m / trial.object.model.diagonal_m, "diag",
                     our_goal(query.name(), kOurError_diag));
            continue;
        }
        rows.add("missed", static_cast<double>(errors.missed), "", our_goal(query.name(), 0.0));
        rows.add("invented", static_cast<double>(errors.invented), "", our_goal(query.name(), 0.0));
    }
    return std::nullopt;
}

/// How much there was to find.
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
    rows.add("frames that meet", static_cast<double>(meet), "");
    rows.add("pairs a frame that meets",
             static_cast<double>(pairs) / static_cast<double>(std::max<std::size_t>(meet, 1)), "");
    rows.add("pairs at most", static_cast<double>(most), "");
}

} // namespace

CaseFailure run_peer_mesh_case(const CaseContext& context, const PeerMeshCase& test_case)
{
    const auto scene = context.scenes.get(test_case.scene);
    if (!scene)
    {
        return scene.error().text;
    }
    const Scene& object = *scene.value();
    const auto tool = context.scenes.get(make_tool_mesh(object));
    if (!tool)
    {
        return tool.error().text;
    }
    const PinnedCore pinned(context.options.core);
    const PairMeshes meshes{faces_in_source_frame(*tool.value()), faces_in_model_frame(object)};
    MeshTrial trial{context, object, context.options.passes_or(5, 3), {}, {}};
    trial.places = mesh_touch_motion(object.touch(), meshes.tool,
                                     context.options.frames_or(kTouchFrames, kTouchFrames / 3));
    trial.truth = find_pair_truth(*tool.value(), object, trial.places);
    add_truth(trial);
    const auto ours = TactusPairQuery::make(*tool.value(), object);
    if (!ours)
    {
        return ours.error().text;
    }
    if (auto failure = add_contestant(trial, *ours.value()))
    {
        return failure;
    }
    for (const PairPeer& peer : context.options.count ? std::vector<PairPeer>() : pair_peers())
    {
        if (auto failure = add_contestant(trial, *peer.make(meshes)))
        {
            return failure;
        }
    }
    return std::nullopt;
}

} // namespace tactus::bench
