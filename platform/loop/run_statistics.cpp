// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/run_statistics.hpp"

#include <algorithm>

namespace tactus::hrtc
{

void SeriesPoint::take(const SeriesPoint& other) noexcept
{
    force_n = std::max(force_n, other.force_n);
    width_m = std::max(width_m, other.width_m);
    frame_us = std::max(frame_us, other.frame_us);
    for (std::size_t i = 0; i < kStages; ++i)
    {
        stage_us[i] = std::max(stage_us[i], other.stage_us[i]);
    }
}

template <typename Point>
void Series<Point>::add(const Point& frame) noexcept
{
    constexpr std::size_t kHalf = kPoints / 2;
    if (unmerged_from_ < kHalf) // All pairs are merged long before the free half is full.
    {
        now_[unmerged_from_] = merged(unmerged_from_);
        ++unmerged_from_;
    }
    if (used_ > 0 && in_last_ < stride_)
    {
        now_[used_ - 1].take(frame);
        ++in_last_;
        return;
    }
    if (used_ == kPoints)
    {
        now_.swap(before_);
        unmerged_from_ = 0;
        used_ = kHalf;
        stride_ *= 2;
    }
    now_[used_++] = frame;
    in_last_ = 1;
}

template <typename Point>
std::vector<Point> Series<Point>::points() const
{
    std::vector<Point> all(now_.begin(), now_.begin() + static_cast<std::ptrdiff_t>(used_));
    for (std::size_t pair = unmerged_from_; pair < kPoints / 2; ++pair)
    {
        all[pair] = merged(pair);
    }
    return all;
}

template <typename Point>
Point Series<Point>::merged(std::size_t pair) const noexcept
{
    Point point = before_[2 * pair];
    point.take(before_[2 * pair + 1]);
    return point;
}

template class Series<SeriesPoint>;
template class Series<PathPoint>;

namespace
{

/// Rank of an answer, 0 (best) to 4 (worst); a frame ranks as its worst pair.
int badness(AnswerKind kind) noexcept
{
    switch (kind)
    {
    case AnswerKind::separated:
        return 0;
    case AnswerKind::exact:
        return 1;
    case AnswerKind::within_tolerance:
        return 2;
    case AnswerKind::bounded:
        return 3;
    case AnswerKind::stale:
        return 4;
    }
    return 4;
}

bool is_felt(const ToolOutput& output, const ToolForce& force) noexcept
{
    return output.in_contact && force.push.force_n.squaredNorm() > 0.0;
}

} // namespace

void AnswerCounts::add(AnswerKind kind, double width_m, double tolerated_m) noexcept
{
    const bool is_inexact = kind == AnswerKind::bounded || kind == AnswerKind::stale;
    exact += kind == AnswerKind::exact ? 1 : 0;
    separated += kind == AnswerKind::separated ? 1 : 0;
    within_tolerance += kind == AnswerKind::within_tolerance ? 1 : 0;
    bounded += kind == AnswerKind::bounded ? 1 : 0;
    stale += kind == AnswerKind::stale ? 1 : 0;
    inexact_run_ = is_inexact ? inexact_run_ + 1 : 0;
    longest_inexact_run = std::max(longest_inexact_run, inexact_run_);
    tolerated_max_m = std::max(tolerated_max_m, tolerated_m);
    width_max_m = is_inexact ? std::max(width_max_m, width_m) : width_max_m;
}

void ForceCounts::add(const ToolOutput& output, const ToolForce& force) noexcept
{
    add_sent(force, output.in_contact);
    contact_frames += output.in_contact ? 1 : 0;
    force_frames += is_felt(output, force) ? 1U : 0U;
    halted_frames += output.halted ? 1 : 0;
    data_limited_frames += output.data_limited ? 1 : 0;
    lag_max_m = std::max(lag_max_m, output.lag_m);
    twist_max_rad = std::max(twist_max_rad, force.twist_rad);
    fixture_max_n = std::max(fixture_max_n, force.own_n);
    load_max_n = std::max(load_max_n, force.load_n.norm());
    load_max_nm = std::max(load_max_nm, force.load_nm.norm());
    if (has_action(force.push.actions, ForceAction::stiffness_limited))
    {
        least_stiffness_n_per_m = std::min(least_stiffness_n_per_m, force.push.stiffness_n_per_m);
    }
    observed_energy_max_j = std::max(
        {observed_energy_max_j, force.push.observed_energy_j, force.torque.observed_energy_j});
    for (std::size_t bit = 0; bit < kForceActions; ++bit)
    {
        const auto action = static_cast<ForceAction>(1U << bit);
        const ForceAction actions = force.push.actions | force.torque.actions;
        conditioned[bit] += has_action(actions, action) ? 1U : 0U;
    }
}

/// Updates the maxima of force and torque and of their steps. The fade at the run's end does not
/// count. A fade in the air sends only damping, which is no contact force; neither it nor its end
/// counts as a step.
void ForceCounts::add_sent(const ToolForce& force, bool in_contact) noexcept
{
    const bool is_damping_air = force.causes != ForceOff::none && !in_contact;
    if (!is_damping_air && !has_cause(force.causes, ForceOff::software))
    {
        max_n = std::max(max_n, force.push.force_n.norm());
        torque_max_nm = std::max(torque_max_nm, force.torque.force_n.norm());
        if (!damped_air_)
        {
            max_step_n = std::max(max_step_n, (force.push.force_n - last_n_).norm());
            torque_max_step_nm =
                std::max(torque_max_step_nm, (force.torque.force_n - last_nm_).norm());
        }
    }
    damped_air_ = is_damping_air;
    last_n_ = force.push.force_n;
    last_nm_ = force.torque.force_n;
}

void WorkRange::add(std::uint32_t work, bool is_first) noexcept
{
    min = is_first ? work : std::min(min, work);
    max = std::max(max, work);
    sum += work;
}

RunStatistics::RunStatistics(std::size_t tool_count, std::size_t object_count,
                             std::size_t model_count, Duration period)
    : paths(tool_count)
    , deadlines(period)
    , objects(object_count)
    , pairs(tool_count * object_count)
    , tools(tool_count)
    , models(model_count)
{
}

void RunStatistics::add(const FrameOutput& output, std::span<const ToolForce> forces,
                        const CycleMeasures& measures) noexcept
{
    const std::uint64_t index = frames++;
    for (std::size_t i = 0; i < kStages; ++i)
    {
        stages[i].record(measures.stage[i]);
    }
    frame.record(measures.frame);
    cpu.record(measures.cpu);
    wake.record(measures.cycle.wake_lateness);
    add_point(measures, forces, add_answers(output));
    add_work(output);
    add_scene(output);
    add_work_budget(output.work, measures);
    deadlines.add(index, measures, output.work.budget.used(),
                  is_over_budget(output.work, measures.budgets));
    bool any_contact = false;
    bool any_force = false;
    bool any_data_limited = false;
    for (std::size_t i = 0; i < tools.size(); ++i)
    {
        tools[i].add(output.tools[i], forces[i]);
        const Vec3& place_m = output.tools[i].proxy_m;
        paths[i].add({{static_cast<float>(place_m.x()), static_cast<float>(place_m.y()),
                       static_cast<float>(place_m.z())},
                      static_cast<float>(forces[i].push.force_n.norm())});
        any_contact = any_contact || output.tools[i].in_contact;
        any_force = any_force || is_felt(output.tools[i], forces[i]);
        any_data_limited = any_data_limited || output.tools[i].data_limited;
    }
    contact_frames += any_contact ? 1 : 0;
    force_frames += any_force ? 1 : 0;
    data_limited_frames += any_data_limited ? 1 : 0;
    std::copy(output.models.begin(), output.models.end(), models.begin());
}

double RunStatistics::add_answers(const FrameOutput& output) noexcept
{
    AnswerKind worst = AnswerKind::separated;
    double widest_m = 0.0;
    double tolerated_m = 0.0;
    for (const PairOutput& pair : output.pairs)
    {
        const double width_m = pair.upper_m - pair.lower_m;
        const double here_m = pair.kind == AnswerKind::within_tolerance ? pair.tolerated_m : 0.0;
        pairs[pair.tool * objects + pair.object].add(pair.kind, width_m, here_m);
        tolerated_m = std::max(tolerated_m, here_m);
        if (badness(pair.kind) > badness(worst))
        {
            worst = pair.kind;
        }
        if (badness(pair.kind) > badness(AnswerKind::within_tolerance))
        {
            widest_m = std::max(widest_m, width_m);
        }
    }
    answers.add(worst, widest_m, tolerated_m);
    return widest_m;
}

void RunStatistics::add_point(const CycleMeasures& measures, std::span<const ToolForce> forces,
                              double width_m) noexcept
{
    SeriesPoint point;
    for (const ToolForce& force : forces)
    {
        point.force_n = std::max(point.force_n, static_cast<float>(force.push.force_n.norm()));
    }
    point.width_m = static_cast<float>(width_m);
    point.frame_us = static_cast<float>(to_us(measures.frame));
    for (std::size_t i = 0; i < kStages; ++i)
    {
        point.stage_us[i] = static_cast<float>(to_us(measures.stage[i]));
    }
    series.add(point);
}

void RunStatistics::add_work(const FrameOutput& output) noexcept
{
    splits += output.work.splits;
    merges += output.work.merges;
    nodes_visited += output.work.nodes_visited;
    pages_adopted += output.work.pages_adopted;
    cache_hits += output.work.cache_hits;
    cache_misses += output.work.cache_misses;
    evictions += output.work.evictions;
    for (std::size_t i = 0; i < kSkips; ++i)
    {
        skipped[i] += output.work.skipped.times()[i];
    }
    for (std::size_t bit = 0; bit < faults.size(); ++bit)
    {
        faults[bit] += (static_cast<std::uint32_t>(output.faults) >> bit) & 1U;
    }
}

void RunStatistics::add_scene(const FrameOutput& output) noexcept
{
    const SceneOutput& scene = output.scene;
    objects_now = scene.objects;
    objects_max = std::max(objects_max, scene.objects);
    pairs_awake_max = std::max(pairs_awake_max, scene.pairs);
    capacity_exceeded_frames += scene.tools_over_capacity > 0 ? 1 : 0;
    invisible_wall_frames += scene.walled_tools > 0 ? 1 : 0;
    scene_walks += scene.walks;
    shed_pairs += static_cast<std::uint64_t>(
        std::ranges::count_if(output.pairs, [](const PairOutput& pair) { return pair.is_shed; }));
    for (std::size_t i = 0; i < kChangeRefusals; ++i)
    {
        changes_refused[i] += scene.refused[i];
    }
}

void RunStatistics::add_work_budget(const WorkCounters& work,
                                    const CycleMeasures& measures) noexcept
{
    work_allowed.add(measures.budgets.work, frames == 1);
    work_done.add(work.budget.used(), frames == 1);
    work_at_floor += measures.is_work_at_floor ? 1 : 0;
}

bool RunStatistics::is_over_budget(const WorkCounters& work, const Budgets& limits) const noexcept
{
    constexpr std::uint32_t kWalks = 2 * kFrameWalks;
    return work.splits > limits.splits || work.merges > limits.merges ||
           work.scanned > limits.scanned || work.nodes_visited > kWalks * limits.nodes ||
           work.triangles_tested > kWalks * limits.triangles ||
           work.planes_looked_at > kFrameWalks * limits.planes ||
           work.pages_adopted > limits.pages || work.requests > limits.requests + limits.regions ||
           work.regions_searched > limits.regions ||
           work.budget.used() > WorkBudget::most_of(limits.work);
}

std::vector<std::pair<const char*, LatencyHistogram>> RunStatistics::times() const
{
    std::vector<std::pair<const char*, LatencyHistogram>> all;
    for (std::size_t i = 0; i < kStages; ++i)
    {
        all.emplace_back(kStageNames[i], stages[i]);
    }
    all.emplace_back("frame", frame);
    all.emplace_back("cpu", cpu);
    all.emplace_back("wake", wake);
    all.emplace_back("response", deadlines.response());
    return all;
}

} // namespace tactus::hrtc
