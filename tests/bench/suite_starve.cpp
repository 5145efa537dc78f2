// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Suite `starve`: force on a tool in contact while others use up the shared budgets.

#include "host_tools/shapes/shapes.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/suites.hpp"
#include "tests/shared/greedy_tools.hpp"

namespace tactus::bench
{

namespace
{

constexpr std::uint32_t kFaces = 200'000;
constexpr std::uint32_t kStarvedBaseFaces = 500;

void run_starve_case(const CaseContext& context, const test::GreedyCase& greedy)
{
    const PinnedCore pinned(context.options.core);
    const test::TestModel& model = test::test_model(
        "bumpy-200k", make_shape(Shape::bumpy_sphere, kFaces).value(), kStarvedBaseFaces);
    const std::uint32_t frames = context.options.frames_or(4'000, 1'000);
    const test::GreedyFigures figures = test::run_greedy(model, greedy, frames, kSeed);
    if (!figures.broken.empty())
    {
        throw Failure(figures.broken);
    }
    const bool shares_contact = greedy.others == test::GreedyCase::Others::are_held;
    Row common = context.common_row(model.name);
    common.setting = greedy.name;
    common.frames = frames;
    CaseRows rows(context.rows, common);
    rows.add("exact", figures.exact_percent(), "%", 100.0).is_least = true;
    rows.add("data-limited", figures.data_limited_percent(), "%", shares_contact ? 5.0 : 0.0);
    rows.add("force step", figures.force_step_n, "N", shares_contact ? 0.1 : 0.05);
    rows.add("splits, most of a frame", figures.splits_max, "", greedy.splits);
    rows.add("shed", 100.0 * figures.shed / frames, "%");
    rows.add("no room", 100.0 * figures.full / frames, "%");
}

std::vector<Case> starve_cases()
{
    std::vector<Case> cases;
    for (const test::GreedyCase& greedy : test::greedy_cases())
    {
        cases.push_back(make_case(greedy.name, When::always, run_starve_case, greedy));
    }
    return cases;
}

} // namespace

Suite starve_suite()
{
    return {"starve", starve_cases};
}

} // namespace tactus::bench
