// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Queries of a static model: one sphere in the touching motion, compared with the peers, over
/// trees of the whole mesh.

#include "tests/bench/cases.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/static_model.hpp"
#include "tests/bench/timed_queries.hpp"

#include <algorithm>
#include <array>

namespace tactus::bench
{

namespace
{

constexpr double kStaticNear_diag = 2.0 * kRadius_diag;
/// Tolerances: ours is exact to rounding, the peers use float on coordinates of about a diagonal.
constexpr double kOurTolerance_diag = 1e-9;
constexpr double kStaticTolerance_diag = 2e-6;
constexpr std::uint32_t kColdFrames = 1'000;

Row common_row(const CaseContext& context, const Scene& scene, std::size_t frames,
               std::uint64_t hash)
{
    Row row = context.common_row(scene.model.name);
    row.frames = frames;
    row.hash = hash;
    return row;
}

Questions touch_questions(const CaseContext& context, const Scene& scene)
{
    const std::uint32_t frames = context.options.frames_or(4 * kCycleFrames, kCycleFrames);
    return ask(scene, touch_motion(scene.touch(), frames));
}

/// Times for the same questions; ours first, then the peers'.
std::vector<QueryTimes> time_all(const CaseContext& context, TactusQuery& ours,
                                 const std::vector<std::unique_ptr<PointQuery>>& peers,
                                 const Scene& scene, const Questions& questions, double band_m)
{
    const std::uint32_t passes = context.options.passes_or(5, 3);
    std::vector<QueryTimes> all;
    auto mine =
        time_queries(ours, questions, band_m, kOurTolerance_diag * scene.model.diagonal_m, passes);
    all.push_back(std::move(mine));
    for (const std::unique_ptr<PointQuery>& peer : peers)
    {
        auto theirs = time_queries(*peer, questions, band_m,
                                   kStaticTolerance_diag * scene.model.diagonal_m, passes);
        all.push_back(std::move(theirs));
    }
    return all;
}

/// Adds our quantiles and the first peer's, with the share as the goal; the other peers have their
/// own rows.
void add_against_peers(CaseRows& rows, const std::string& figure,
                       const std::vector<QueryTimes>& times,
                       const std::vector<std::unique_ptr<PointQuery>>& peers,
                       const std::vector<bool>& choice, double p50_share, double p99_share)
{
    const Spread ours = spread_of(chosen(times[0].us.least(), choice));
    std::optional<Spread> peer;
    if (!peers.empty())
    {
        peer = spread_of(chosen(times[1].us.least(), choice));
    }
    const auto add = [&](const char* quantile, double Spread::*part, double share)
    {
        const auto goal = peer ? goal_if(share * peer.value().*part) : std::nullopt;
        Row& row = rows.add(figure + quantile, ours.*part, "us", goal);
        if (peer)
        {
            row.peer = peers[0]->name();
            row.peer_value = peer.value().*part;
        }
    };
    add(".p50", &Spread::p50, p50_share);
    add(".p99", &Spread::p99, p99_share);
    add(".max", &Spread::max, kNoGoal);
    rows.add(figure + ".raw_max", times[0].us.raw_max(), "us");
}

/// Adds the work of a near question, the same on every machine.
void add_near_work(CaseRows& rows, TactusQuery& ours, const Questions& questions,
                   const std::vector<bool>& near, double band_m)
{
    double asked = 0.0;
    double nodes = 0.0;
    double triangles = 0.0;
    double sum_m = 0.0;
    for (std::size_t i = 0; i < near.size(); ++i)
    {
        const std::uint64_t nodes_before = ours.nodes_visited();
        const std::uint64_t triangles_before = ours.triangles_tested();
        sum_m += ours.distance_m(questions.points_m[i], band_m);
        if (near[i])
        {
            asked += 1.0;
            nodes += static_cast<double>(ours.nodes_visited() - nodes_before);
            triangles += static_cast<double>(ours.triangles_tested() - triangles_before);
        }
    }
    const volatile double used = sum_m;
    static_cast<void>(used);
    rows.add("T_Q near, nodes and blocks", nodes / asked, "a question");
    rows.add("T_Q near, triangles", triangles / asked, "a question");
}

/// Times of near questions with evicted caches, optionally warmed.
Spread cold_spread(TactusQuery& ours, const Questions& questions, const std::vector<bool>& near,
                   double band_m, bool warmed)
{
    CacheEvictor evictor;
    std::vector<double> times_us;
    double sum_m = 0.0;
    for (std::size_t i = 0; i < near.size() && times_us.size() < kColdFrames; ++i)
    {
        if (!near[i])
        {
            continue;
        }
        sum_m += ours.distance_m(questions.points_m[i > 0 ? i - 1 : 0], band_m);
        evictor.evict();
        if (warmed)
        {
            ours.warm_caches();
        }
        const BenchClock::time_point start = BenchClock::now();
        sum_m += ours.distance_m(questions.points_m[i], band_m);
        times_us.push_back(microseconds(start, BenchClock::now()));
    }
    const volatile double used = sum_m;
    static_cast<void>(used);
    return spread_of(times_us);
}

void add_spread(CaseRows& rows, const std::string& figure, const Spread& spread, double p99_goal)
{
    rows.add(figure + ".p50", spread.p50, "us");
    rows.add(figure + ".p99", spread.p99, "us", goal_if(p99_goal));
    rows.add(figure + ".max", spread.max, "us");
}

} // namespace

void run_static_case(const CaseContext& context, const StaticCase& test_case)
{
    const Scene& touched = context.scenes.get(test_case.scene);
    const PinnedCore pinned(context.options.core);
    StaticModel model(touched);
    const auto peers = context.options.count ? std::vector<std::unique_ptr<PointQuery>>{}
                                             : make_peers(touched.model.faces);
    const Questions questions = touch_questions(context, touched);
    const double band_m = kStaticNear_diag * touched.model.diagonal_m;
    const std::vector<bool> near = questions.nearer_than(band_m);
    TactusQuery ours(model.tree());
    const auto banded = time_all(context, ours, peers, touched, questions, band_m);
    const auto unbounded =
        time_all(context, ours, peers, touched, questions, std::numeric_limits<double>::infinity());
    const std::uint64_t hash = banded[0].hash + 3 * unbounded[0].hash;
    CaseRows rows(context.rows, common_row(context, touched, questions.points_m.size(), hash));
    add_against_peers(rows, "T_Q near", banded, peers, near, test_case.near_p50,
                      test_case.near_p99);
    add_against_peers(rows, "T_Q exact flight", unbounded, peers,
                      std::vector<bool>(near.size(), true), kNoGoal, test_case.flight_p99);
    add_near_work(rows, ours, questions, near, band_m);
    if (!context.options.count)
    {
        const double warm_p99 = quantile(chosen(banded[0].us.least(), near), 0.99);
        add_spread(rows, "T_Q near, warmed", cold_spread(ours, questions, near, band_m, true),
                   test_case.warmed_p99 * warm_p99);
        add_spread(rows, "T_Q near, cold", cold_spread(ours, questions, near, band_m, false),
                   kNoGoal);
    }
}

void run_growth_case(const CaseContext& context, const GrowthCase& test_case)
{
    static constexpr std::array<SceneSource, 4> kSizes{
        SceneSource{"growth-4k", nullptr, 0, 4'000}, SceneSource{"growth-40k", nullptr, 0, 40'000},
        SceneSource{"growth-400k", nullptr, 0, 400'000},
        SceneSource{"growth-4M", nullptr, 0, 4'000'000}};
    std::vector<double> p50_us;
    for (const SceneSource& size : kSizes)
    {
        const Scene& touched = context.scenes.get(size);
        const PinnedCore pinned(context.options.core);
        StaticModel model(touched);
        const auto peers = make_peers(touched.model.faces);
        const Questions questions = touch_questions(context, touched);
        const double band_m = kStaticNear_diag * touched.model.diagonal_m;
        TactusQuery ours(model.tree());
        const auto times = time_all(context, ours, peers, touched, questions, band_m);
        const std::vector<bool> near = questions.nearer_than(band_m);
        CaseRows rows(context.rows, common_row(context, touched, near.size(), times[0].hash));
        add_against_peers(rows, "T_Q near", times, peers, near, kNoGoal, kNoGoal);
        add_near_work(rows, ours, questions, near, band_m);
        p50_us.push_back(quantile(chosen(times[0].us.least(), near), 0.5));
        if (&size == &kSizes.back())
        {
            rows.add("growth 4 k to 4 M", p50_us.back() / p50_us.front(), "x", test_case.growth);
        }
    }
}

} // namespace tactus::bench
