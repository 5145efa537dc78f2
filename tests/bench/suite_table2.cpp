// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Suite `table2`: Table 2 of the 3DIM 2005 paper, a mesh that touches a mesh. The same motion
/// against the whole object, its base mesh alone, and the object refined locally at the tool.

#include "rt_core/math/vec3.hpp"
#include "rt_core/records/frame_output.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/mesh_touch.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/bench/static_model.hpp"
#include "tests/bench/suites.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/stability/whole_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::bench
{
namespace
{

/// Query-only mesh tool, which follows the device pose and renders no force.
struct PairRun
{
    const Scene& tool;
    const Scene& object;
    std::vector<ToolState> places; ///< Poses in the frame of the object's model.
    double radius_m{0.0};          ///< Radius within which distances must be exact.
    double speed_m_per_s{0.0};     ///< Greatest speed of a point of the tool.
    std::size_t pool_bytes{0};     ///< Pools of both models.
    bool is_static{false};         ///< Both models are resident and refined before the first pose.
};

/// Times and answers of the frames of a run.
struct PairFrames
{
    std::array<LeastTimes, kStages> stage_us;
    LeastTimes sum_us; ///< T = T_R + T_B + T_Q + T_L.
    std::vector<PairOutput> answers;
    WorkCounters work;
    std::uint32_t active_faces{0}; ///< Most active faces of the object.
    std::uint64_t meeting_pairs{0};
    std::uint64_t hash{0}; ///< Hash of answers and states.
};

/// Frames at the first place before the measurement, in which a local model is loaded and refined.
constexpr std::uint32_t kPairLeadIn = 500;

test::RigOptions options_of(const PairRun& run)
{
    test::RigOptions options;
    options.pool_bytes = run.pool_bytes;
    options.static_when_it_fits = run.is_static;
    ToolSpec tool;
    tool.radius_m = run.radius_m;
    tool.speed_max_m_per_s = run.speed_m_per_s;
    tool.core = MeshCore{ModelId{1}};
    tool.query_only = true;
    tool.wants_pairs = true;
    options.tools = {tool};
    return options;
}

std::uint64_t bits_of(const FrameOutput& output)
{
    const PairOutput& pair = output.pairs[0];
    return std::bit_cast<std::uint64_t>(pair.lower_m) +
           3 * std::bit_cast<std::uint64_t>(pair.upper_m) + 5 * pair.mesh->meeting.size() +
           7 * output.models[0].state_hash + 11 * output.models[1].state_hash;
}

void keep(const StageTimer& timer, std::size_t frame, PairFrames& frames)
{
    double sum_us = 0.0;
    for (const Stage stage : {Stage::load, Stage::refine, Stage::refit, Stage::query})
    {
        frames.stage_us[static_cast<std::size_t>(stage)].keep(frame, timer.us(stage));
        sum_us += timer.us(stage);
    }
    frames.sum_us.keep(frame, sum_us);
}

/// Runs once; returns the hash.
std::uint64_t replay_once(const PairRun& run, PairFrames& frames)
{
    test::FrameRig rig({&run.object.model, &run.tool.model}, options_of(run));
    if (run.is_static)
    {
        test::refine_fully(run.object.model.name, [&](const Budgets& budgets)
                           { return rig.step(std::span(run.places).first(1), budgets); });
    }
    for (std::uint32_t i = 0; i < kPairLeadIn; ++i)
    {
        rig.step(std::span(run.places).first(1), {});
    }
    const bool is_first = frames.answers.empty();
    StageTimer timer;
    std::uint64_t hash = 0;
    for (std::size_t i = 0; i < run.places.size(); ++i)
    {
        rig.deliver();
        const FrameInput input = rig.input(std::span(run.places).subspan(i, 1), {});
        timer.begin();
        const FrameOutput output = rig.frame().run(input, timer.mark());
        keep(timer, i, frames);
        hash += bits_of(output) * (2 * i + 1);
        if (is_first)
        {
            frames.answers.push_back(output.pairs[0]);
            frames.work += output.work;
            frames.meeting_pairs += output.pairs[0].mesh->meeting.size();
            frames.active_faces = std::max(frames.active_faces, rig.model().forest.active_faces());
        }
    }
    return hash;
}

/// Replays a run `passes` times, after some frames at its first pose. A failure if passes differ.
PairFrames replay_pair(const PairRun& run, std::uint32_t passes)
{
    PairFrames frames;
    frames.stage_us.fill(LeastTimes(run.places.size()));
    frames.sum_us = LeastTimes(run.places.size());
    for (std::uint32_t pass = 0; pass < passes; ++pass)
    {
        const std::uint64_t hash = replay_once(run, frames);
        if (pass > 0 && hash != frames.hash)
        {
            throw Failure(run.object.model.name + ": replays gave other answers");
        }
        frames.hash = hash;
    }
    return frames;
}

/// Speed limit, above the motion's slide and rotation together.
constexpr double kProbeFastest_diag_per_s = 0.5;
/// Memory of the tool's model and of tables.
constexpr std::size_t kToolBytes = 8 * kMiB;
constexpr double kActiveGoal_percent = 5.0;

struct Table2Case
{
    SceneSource scene;
    std::size_t local_bytes; ///< Pools of the locally refined object and the tool.
    double refine_us{kNoGoal};
    double query_to_static{kNoGoal};
    double frame_to_static{kNoGoal};
    bool is_in_paper{false};
};

/// Times of the paper in microseconds; its bunny has 37,576 faces.
struct PaperTimes
{
    const char* by;
    Stage stage;
    double us;
};
constexpr std::array kPaperTimes{
    PaperTimes{"original static", Stage::query, 5'700.0},
    PaperTimes{"base static", Stage::query, 2'750.0},
    PaperTimes{"local", Stage::query, 2'870.0},
    PaperTimes{"local", Stage::refine, 5'400.0},
    PaperTimes{"local", Stage::refit, 1'800.0},
};

/// Goals of one of the three variants.
struct Table2Goals
{
    double refine_us{kNoGoal};
    double active_percent{kNoGoal};
    double error_diag{kNoGoal};
};

class Table2
{
public:
    Table2(const CaseContext& context, const Table2Case& test_case, const Scene& object,
           const Scene& tool)
        : context_(context), case_(test_case), object_(object), tool_(tool)
    {
        const auto places =
            mesh_touch_motion(object.touch(), faces_in_source_frame(tool), MeshProbe::large,
                              context.options.frames_or(2'000, 500));
        truth_ = find_pair_truth(tool, object, places);
        for (const Similarity& place : places)
        {
            ToolState& state = places_.emplace_back();
            state.position_m = place.translation_m;
            state.rotation = place.rotation;
        }
    }

    void run()
    {
        const Scene& base =
            context_.scenes.get(coarser_mesh("base-of-" + object_.model.name, object_.model, 1));
        add("original static", object_, ample_pool_bytes(object_), true,
            {kNoGoal, kNoGoal, kOurError_diag});
        add("base static", base, ample_pool_bytes(base), true, {});
        add("local", object_, case_.local_bytes, false,
            {case_.refine_us, kActiveGoal_percent, kOurError_diag});
    }

private:
    void add(const char* by, const Scene& object, std::size_t object_bytes, bool is_static,
             const Table2Goals& goals)
    {
        const double diagonal_m = object_.model.diagonal_m;
        PairRun run{tool_,
                    object,
                    places_,
                    kMeshSkin_diag * diagonal_m,
                    kProbeFastest_diag_per_s * diagonal_m,
                    object_bytes + (is_static ? kToolBytes : 0),
                    is_static};
        for (ToolState& place : run.places)
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                place.position_m[static_cast<Eigen::Index>(axis)] +=
                    object_.model.origin_m[axis] - object.model.origin_m[axis];
            }
        }
        const auto frames = replay_pair(run, context_.options.passes_or(5, 3));
        add_rows(by, run, frames, goals);
    }

    void add_rows(const char* by, const PairRun& run, const PairFrames& frames,
                  const Table2Goals& goals)
    {
        Row common = context_.common_row(run.object.model.name);
        common.by = by;
        common.frames = run.places.size();
        common.hash = frames.hash;
        CaseRows rows(context_.rows, common);
        add_times(rows, by, frames, goals);
        const auto faces = static_cast<double>(object_.model.faces.size());
        rows.add("active faces", 100.0 * frames.active_faces / faces, "%",
                 goal_if(goals.active_percent));
        const double error_m = largest_error_m(run, frames, goals.error_diag < kNoGoal);
        rows.add("error max", error_m / object_.model.diagonal_m, "diag",
                 goal_if(goals.error_diag));
        rows.add("open answers", percent_open(frames), "%");
        rows.add("meeting pairs",
                 static_cast<double>(frames.meeting_pairs) / static_cast<double>(run.places.size()),
                 "/frame");
        rows.add("splits", frames.work.splits / static_cast<double>(run.places.size()), "/frame");
        rows.add("pools", static_cast<double>(run.pool_bytes) / kMiB, "MiB");
    }

    void add_times(CaseRows& rows, const std::string& by, const PairFrames& frames,
                   const Table2Goals& goals)
    {
        constexpr std::array kNames{std::pair(Stage::query, "T_Q"), std::pair(Stage::refit, "T_B"),
                                    std::pair(Stage::refine, "T_R"), std::pair(Stage::load, "T_L")};
        for (const auto& [stage, name] : kNames)
        {
            const Spread us = spread_of(frames.stage_us[static_cast<std::size_t>(stage)].least());
            const bool has_goal = stage == Stage::refine;
            Row& row = rows.add(fmt::format("{}.p50", name), us.p50, "us",
                                has_goal ? goal_if(goals.refine_us) : std::nullopt);
            const auto* const paper =
                std::ranges::find_if(kPaperTimes, [&, stage = stage](const PaperTimes& times)
                                     { return by == times.by && stage == times.stage; });
            if (case_.is_in_paper && paper != kPaperTimes.end())
            {
                row.peer = "paper";
                row.peer_value = paper->us;
            }
            rows.add(fmt::format("{}.p99", name), us.p99, "us");
            query_us_ = by == "original static" && stage == Stage::query ? us.p50 : query_us_;
            if (by == "local" && stage == Stage::query)
            {
                rows.add("T_Q.p50 to static", us.p50 / query_us_, "",
                         goal_if(case_.query_to_static));
            }
        }
        const Spread sum_us = spread_of(frames.sum_us.least());
        rows.add("T.p50", sum_us.p50, "us");
        rows.add("T.p99", sum_us.p99, "us");
        if (by == "local")
        {
            rows.add("T.p50 to static T_Q", sum_us.p50 / query_us_, "",
                     goal_if(case_.frame_to_static));
        }
    }

    static double percent_open(const PairFrames& frames)
    {
        const auto open = std::ranges::count_if(
            frames.answers, [](const PairOutput& answer)
            { return answer.kind != AnswerKind::exact && answer.kind != AnswerKind::separated; });
        return 100.0 * static_cast<double>(open) / static_cast<double>(frames.answers.size());
    }

    /// Greatest error of answers against the object's own surface; a separated answer denies
    /// contact within the skin. A failure if bounds that must hold the truth do not.
    [[nodiscard]] double largest_error_m(const PairRun& run, const PairFrames& frames,
                                         bool holds_truth) const
    {
        double largest = 0.0;
        for (std::size_t i = 0; i < frames.answers.size(); ++i)
        {
            const PairOutput& answer = frames.answers[i];
            const double truth = truth_.distances_m[i];
            const double rounding = kOurError_diag * object_.model.diagonal_m;
            if (holds_truth &&
                (answer.lower_m > truth + rounding || answer.upper_m < truth - rounding))
            {
                throw Failure(run.object.model.name + ": an answer does not hold the truth");
            }
            const double error = answer.kind == AnswerKind::separated
                                     ? run.radius_m - truth
                                     : std::max(answer.upper_m - truth, truth - answer.lower_m);
            largest = std::max(largest, error);
        }
        return largest;
    }

    const CaseContext& context_;
    const Table2Case& case_;
    const Scene& object_;
    const Scene& tool_;
    std::vector<ToolState> places_;
    PairTruth truth_;
    double query_us_{0.0}; ///< T_Q against the whole object.
};

void run_table2_case(const CaseContext& context, const Table2Case& test_case)
{
    const Scene& object = context.scenes.get(test_case.scene);
    const Scene& tool = context.scenes.get(make_tool_mesh(object, MeshProbe::large));
    const PinnedCore pinned(context.options.core);
    Table2(context, test_case, object, tool).run();
}

std::vector<Case> table2_cases()
{
    const auto one = [](const char* name, When when, const Table2Case& test_case)
    { return make_case(name, when, run_table2_case, test_case); };
    return {
        one("bunny", When::always, {kBunny, 3 * kMiB, 40.0, 1.35, 2.1, true}),
        one("igea", When::full_only, {kIgea, 16 * kMiB}),
        one("1.1M", When::full_only, {kFineBunny, 32 * kMiB, kNoGoal, 1.3}),
        one("tiny", When::named_only, {kTiny, kMiB}),
    };
}

} // namespace

Suite table2_suite()
{
    return {"table2", table2_cases};
}

} // namespace tactus::bench
