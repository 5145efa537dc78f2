// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Suite `worst`: greatest cost of a frame under motions made to be expensive, for every kind of
/// tool. With --instructions in instructions, which are the same on every machine.

#include "tests/bench/instruction_count.hpp"
#include "tests/bench/least_times.hpp"
#include "tests/bench/stage_timer.hpp"
#include "tests/bench/suites.hpp"
#include "tests/bench/worst_motions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <variant>

namespace tactus::bench
{

namespace
{

struct Rate
{
    const char* name;
    std::int64_t period_ns;
    double instructions; ///< Goal in instructions.
};
constexpr std::array<Rate, 2> kRates{{{"1 kHz", 1'000'000, 600'000}, {"4 kHz", 250'000, 150'000}}};

/// Greatest amounts in a frame.
struct MostWork
{
    std::uint32_t splits{0};
    std::uint32_t nodes{0};
    std::uint32_t triangles{0};
    std::uint32_t planes{0};
    std::uint32_t work{0}; ///< WorkBudget::used().

    void see(const WorkCounters& work_done)
    {
        splits = std::max(splits, work_done.splits);
        nodes = std::max(nodes, work_done.nodes_visited);
        triangles = std::max(triangles, work_done.triangles_tested);
        planes = std::max(planes, work_done.planes_looked_at);
        work = std::max(work, work_done.budget.used());
    }
};

class WorstReplay
{
public:
    /// Replays with half of the period for each frame, like hrtc.
    WorstReplay(const WorstRun& run, std::int64_t period_ns)
        : run_(run), frame_us_(run.moments.size())
    {
        const auto times_of = [](const ToolSpec& tool)
        {
            return is_mesh(tool)                             ? Budgets::kMeshWork
                   : std::holds_alternative<Hull>(tool.core) ? Budgets::kHullWork
                                                             : 1U;
        };
        const std::uint32_t times =
            times_of(*std::ranges::max_element(run.rig.tools, {}, times_of));
        budgets_.work = Budgets::work_of(period_ns / 2, times);
    }

    /// A failure if the frames differ from those of an earlier pass.
    void run(std::uint32_t passes)
    {
        for (std::uint32_t pass = 0; pass < passes; ++pass)
        {
            const std::uint64_t hash = run_once();
            if (pass > 0 && hash != hash_)
            {
                throw Failure("a replay of the same motion ended otherwise");
            }
            hash_ = hash;
        }
    }

    [[nodiscard]] const std::vector<double>& frame_us() const { return frame_us_.least(); }
    [[nodiscard]] const MostWork& most() const { return most_; }
    [[nodiscard]] std::uint64_t hash() const { return hash_; }

private:
    [[nodiscard]] std::uint64_t run_once()
    {
        test::FrameRig rig(run_.models, run_.rig);
        StageTimer timer;
        std::uint64_t hash = 0;
        for (std::size_t i = 0; i < run_.moments.size(); ++i)
        {
            const WorstMoment& moment = run_.moments[i];
            for (const SceneChange& change : moment.changes)
            {
                rig.change(change);
            }
            if (moment.is_delivered)
            {
                rig.deliver();
            }
            timer.begin();
            const FrameOutput output = counted_step(rig, moment.tools, budgets_, timer.mark());
            frame_us_.keep(i, timer.sum_us());
            most_.see(output.work);
            for (const ModelOutput& model : output.models)
            {
                hash = 31 * hash + model.state_hash;
            }
        }
        return hash;
    }

    const WorstRun& run_;
    Budgets budgets_;
    LeastTimes frame_us_;
    MostWork most_;
    std::uint64_t hash_{0};
};

void add_instructions(CaseRows& rows, std::span<const StageCounts> frames, double goal)
{
    const auto sum = [](const StageCounts& stages)
    { return std::accumulate(stages.begin(), stages.end(), std::uint64_t{0}); };
    const StageCounts& most = *std::ranges::max_element(frames, {}, sum);
    rows.add("most of a frame", static_cast<double>(sum(most)), "instructions", goal);
    for (std::size_t stage = 0; stage < kStages; ++stage)
    {
        rows.add(fmt::format("of them {}", kStageNames[stage]), static_cast<double>(most[stage]),
                 "instructions");
    }
}

struct ToolCases
{
    const char* name;
    std::vector<WorstCase> cases;
};

void run_tool_cases(const CaseContext& context, const ToolCases& tool)
{
    const PinnedCore pinned(context.options.core);
    const std::vector<StageCounts> counted = count_stages(context);
    std::span<const StageCounts> left(counted);
    for (const WorstCase& worst : tool.cases)
    {
        for (const Rate& rate : kRates)
        {
            const WorstRun run = make_worst_run(worst, rate.period_ns, context.scenes);
            WorstReplay replay(run, rate.period_ns);
            replay.run(context.options.passes_or(3, 1));
            Row common = context.common_row(run.models[0]->name);
            common.setting = fmt::format("{}, {}", worst.name, rate.name);
            common.frames = run.moments.size();
            common.hash = replay.hash();
            CaseRows rows(context.rows, common);
            if (!left.empty())
            {
                add_instructions(rows, left.first(common.frames), rate.instructions);
                left = left.subspan(common.frames);
            }
            rows.add("longest frame", spread_of(replay.frame_us()).max, "us");
            rows.add("splits, most of a frame", replay.most().splits, "");
            rows.add("nodes, most of a frame", replay.most().nodes, "");
            rows.add("triangles, most of a frame", replay.most().triangles, "");
            rows.add("planes, most of a frame", replay.most().planes, "");
            rows.add("work, most of a frame", replay.most().work, "instructions");
        }
    }
}

const std::vector<ToolCases>& all_tools()
{
    using Motion = WorstMotion;
    using Tool = WorstTool;
    static const std::vector<ToolCases> kTools{
        {"ball",
         {{"sunk by a stall", Tool::sphere, Motion::sinks},
          {"everything late", Tool::sphere, Motion::waits},
          {"teleports", Tool::sphere, Motion::teleports, true},
          {"among 32 objects", Tool::sphere, Motion::in_crowd}}},
        {"capsule", {{"sunk by a stall", Tool::capsule, Motion::sinks}}},
        {"box",
         {{"sunk by a stall", Tool::box, Motion::sinks},
          {"measures, turns deep in", Tool::box, Motion::turns, true},
          {"teleports", Tool::box, Motion::teleports, true}}},
        {"hull",
         {{"sunk by a stall", Tool::hull, Motion::sinks},
          {"measures, turns deep in", Tool::hull, Motion::turns, true}}},
        {"mesh",
         {{"sunk by a stall", Tool::mesh, Motion::sinks},
          {"everything late", Tool::mesh, Motion::waits},
          {"measures, turns deep in", Tool::mesh, Motion::turns, true},
          {"teleports", Tool::mesh, Motion::teleports, true},
          {"among 32 objects", Tool::mesh, Motion::in_crowd},
          {"in its equal", Tool::mesh, Motion::equals},
          {"measures, in its equal", Tool::mesh, Motion::equals, true},
          {"a comb in a comb", Tool::mesh, Motion::in_comb},
          {"measures, a comb in a comb", Tool::mesh, Motion::in_comb, true}}},
        {"16 on one spot",
         {{"spheres", Tool::sphere, Motion::sinks, false, 16},
          {"boxes", Tool::box, Motion::sinks, false, 16},
          {"meshes", Tool::mesh, Motion::sinks, false, 16}}},
    };
    return kTools;
}

std::vector<Case> worst_cases()
{
    std::vector<Case> cases;
    for (const ToolCases& tool : all_tools())
    {
        cases.push_back(make_case(tool.name, When::always, run_tool_cases, tool));
    }
    return cases;
}

} // namespace

Suite worst_suite()
{
    return {"worst", worst_cases};
}

} // namespace tactus::bench
