// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/budget_governor.hpp"

#include "rt_core/base/assert.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

/// A triangle costs about a quarter of a node, and a traversal may test four for each node.
constexpr std::uint32_t kTrianglesPerNode = 4;
constexpr double kStepsPerNode = 2.0;
/// Records looked at for each merge that is allowed; eight is the ratio of the usual budgets.
constexpr std::uint32_t kScannedPerMerge = 8;
constexpr double kFirstSteps = 100.0;
constexpr double kFirstPlanes = 60.0;
/// The reserve takes at most this share of the set time, whatever the machine does.
constexpr double kScatterShare = 0.5;

double edits_of(const WorkCounters& work) noexcept
{
    return static_cast<double>(work.splits) + static_cast<double>(work.merges);
}

double steps_of(const WorkCounters& work) noexcept
{
    return static_cast<double>(work.nodes_visited) +
           static_cast<double>(work.triangles_tested) / kTrianglesPerNode;
}

/// Whole units of at least `unit_ns` each that fit, in [least, most].
std::uint32_t fitting(double time_ns, double unit_ns, std::uint32_t least,
                      std::uint32_t most) noexcept
{
    const double units = std::floor(time_ns / unit_ns);
    return static_cast<std::uint32_t>(
        std::clamp(units, static_cast<double>(least), static_cast<double>(most)));
}

/// Falls at once, rises by a sixteenth of the way and at least by one.
std::uint32_t towards(std::uint32_t now, std::uint32_t wanted) noexcept
{
    return wanted <= now ? wanted : now + (wanted - now + 15) / 16;
}

} // namespace

BudgetGovernor::BudgetGovernor(Duration frame_budget, const Budgets& most, std::uint32_t walks,
                               std::uint32_t proxies) noexcept
    : frame_budget_ns_(static_cast<double>(frame_budget.ns))
    , most_(most)
    , walks_(static_cast<double>(walks))
    , proxies_(static_cast<double>(proxies))
    , budgets_(most)
    , rest_ns_(frame_budget_ns_ / 2.0) // Nothing is known yet.
    , scatter_ns_(0.0)
    , steps_(kFirstSteps)
    , planes_(kFirstPlanes)
{
    TACTUS_ASSERT(frame_budget > Duration{});
    TACTUS_ASSERT(walks > 0);
    TACTUS_ASSERT(proxies > 0);
    TACTUS_ASSERT(most.splits >= kSplitsLeast && most.merges >= kSplitsLeast);
    TACTUS_ASSERT(most.scanned >= kScannedLeast && most.nodes >= kNodesLeast);
    TACTUS_ASSERT(most.triangles >= kTrianglesPerNode * kNodesLeast);
    TACTUS_ASSERT(most.planes >= kPlanesLeast);
    choose();
}

void BudgetGovernor::observe(const FrameCost& cost) noexcept
{
    if (!is_stall(cost.frame))
    {
        learn(cost);
        choose();
    }
}

bool BudgetGovernor::is_stall(Duration frame) noexcept
{
    const bool is_long =
        static_cast<double>(frame.ns) > static_cast<double>(kStall) * frame_budget_ns_;
    const bool is_first = is_long && !last_was_long_;
    last_was_long_ = is_long;
    return is_first;
}

void BudgetGovernor::learn(const FrameCost& cost) noexcept
{
    const auto frame_ns = static_cast<double>(cost.frame.ns);
    const auto walked_ns = static_cast<double>(cost.walked.ns);
    const auto force_ns = static_cast<double>(cost.force.ns);
    const double edits = edits_of(cost.work);
    const double steps = steps_of(cost.work);
    const auto planes = static_cast<double>(cost.work.planes_looked_at);
    const bool is_first = frames_ <= 0.0;
    frames_ = std::min(frames_ + 1.0, FrameCostModel::kWindowFrames);
    const double expected_ns =
        rest_ns_ + model_.predict_ns(edits, steps) + force_model_.predict_ns(0.0, planes);
    rest_ns_ += (frame_ns - walked_ns - force_ns - rest_ns_) / frames_;
    model_.observe(walked_ns, edits, steps);
    force_model_.observe(force_ns, 0.0, planes);
    steps_.observe(steps);
    planes_.observe(planes);
    if (!is_first) // Nothing was expected of the first.
    {
        scatter_ns_.observe(
            std::clamp(frame_ns - expected_ns, 0.0, kScatterShare * frame_budget_ns_));
    }
}

void BudgetGovernor::choose() noexcept
{
    const double steps = steps_.level();
    const double plane_ns = force_model_.per_step_ns();
    const double planes_ns = planes_.level() * plane_ns;
    const double fixed_ns = rest_ns_ + scatter_ns_.level() + force_model_.predict_ns(0.0, 0.0);
    const double open_ns = frame_budget_ns_ - fixed_ns - model_.predict_ns(0.0, steps);
    const double room_ns = open_ns - planes_ns;
    const double pair_ns = 2.0 * model_.per_edit_ns(); // A split and a merge.
    Budgets wanted = most_;
    wanted.splits = fitting(room_ns, pair_ns, kSplitsLeast, most_.splits);
    wanted.merges = fitting(room_ns, pair_ns, kSplitsLeast, most_.merges);
    wanted.scanned = std::clamp(kScannedPerMerge * wanted.merges, kScannedLeast, most_.scanned);
    // What edits leave, but at least as much again as is usual, so that a traversal can grow.
    const double spent_ns = pair_ns * static_cast<double>(wanted.splits);
    const double walk_ns =
        steps * model_.per_step_ns() + std::max(room_ns - spent_ns, steps * model_.per_step_ns());
    const double node_ns = walks_ * kStepsPerNode * model_.per_step_ns();
    wanted.nodes = fitting(walk_ns, node_ns, kNodesLeast, most_.nodes);
    wanted.triangles = std::min(kTrianglesPerNode * wanted.nodes, most_.triangles);
    // Proxies that use all of their half leave edits the other one.
    wanted.planes = fitting(std::max(open_ns / 2.0, open_ns - spent_ns), proxies_ * plane_ns,
                            kPlanesLeast, most_.planes);

    is_at_floor_ = room_ns < pair_ns;
    budgets_.splits = towards(budgets_.splits, wanted.splits);
    budgets_.merges = towards(budgets_.merges, wanted.merges);
    budgets_.scanned = towards(budgets_.scanned, wanted.scanned);
    budgets_.nodes = towards(budgets_.nodes, wanted.nodes);
    budgets_.triangles = towards(budgets_.triangles, wanted.triangles);
    budgets_.planes = towards(budgets_.planes, wanted.planes);
}

} // namespace tactus
