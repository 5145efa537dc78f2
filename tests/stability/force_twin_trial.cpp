// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/stability/force_twin_trial.hpp"

#include "tests/stability/press_motion.hpp"
#include "tests/stability/trial_terms.hpp"
#include "tests/stability/whole_model.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

namespace tactus::test
{

namespace
{

/// Radius of 4 to 8 mm, with hundreds of faces in reach.
constexpr double kPressedRadius_diag = 0.04;
/// Proxies coincide within the travel of a spring at 0.5 mN, and forces within 0.5 mN.
constexpr double kTogether_m = 1e-6;
constexpr double kTogether_n = 5e-4;
/// A proxy this close to the end of the certified range was limited by it: more than the skin of a
/// point, and more than the smallest step.
constexpr double kStepEnd_m = 1e-6;
constexpr double kStepEnd = 1e-3;
/// Pages for two such tools, few enough that others are evicted.
constexpr std::size_t kCache_bytes = 40 * sizeof(Page);

bool touches(const ToolOutput& tool)
{
    return tool.in_contact && !tool.halted && !tool.over_constrained;
}

std::string text_of(const Vec3& v)
{
    std::array<char, 128> text{};
    std::snprintf(text.data(), text.size(), "(%.9g, %.9g, %.9g)", v.x(), v.y(), v.z());
    return text.data();
}

class ForceTwinRun
{
public:
    explicit ForceTwinRun(const ForceTwinTrial& trial)
        : trial_(trial)
        , random_(Random::seeded(trial.seed))
        , diagonal_m_(random_.between(kSmallest_m, kLargest_m))
        , rig_(trial.model, options(trial.hardship.rig))
        , whole_(trial.model, options(whole_options(trial.model.faces.size())))
        , judges_(trial.tools)
        , last_(trial.tools)
    {
        figures_.steps = {"force step, " + trial.model.name + ", " + trial.hardship.name +
                              (trial.tools > 1 ? ", two tools" : ""),
                          0,
                          0.0,
                          kForceStep_n,
                          "N",
                          0,
                          {}};
        figures_.after_waits = figures_.steps;
        figures_.after_waits.name += ", after a wait";
        ObjectPose pose;
        pose.scale = diagonal_m_ / trial.model.diagonal_m;
        rig_.place_object(pose);
        whole_.place_object(pose);
        for (std::uint32_t tool = 0; tool < trial.tools; ++tool)
        {
            motions_.emplace_back(trial.model, trial.tree, radius_m(), pose.scale, random_);
        }
    }

    [[nodiscard]] ForceTwinFigures run()
    {
        std::vector<Vec3> goals = next_goals();
        refine_fully(figures_.steps.name,
                     [&](const Budgets& budgets) { return whole_.step(goals, budgets); });
        for (frame_ = 0; frame_ < trial_.frames; ++frame_)
        {
            const FrameOutput ours = rig_.step(goals, trial_.hardship.budgets);
            const FrameOutput full = whole_.step(goals, trial_.hardship.budgets);
            for (std::uint32_t tool = 0; tool < trial_.tools; ++tool)
            {
                judge(tool, ours, full, goals[tool]);
            }
            goals = next_goals();
        }
        return figures_;
    }

private:
    [[nodiscard]] double radius_m() const { return trial_.hardship.radius_diag * diagonal_m_; }

    [[nodiscard]] RigOptions options(const RigOptions& of_models) const
    {
        RigOptions options = with_tool(of_models, radius_m());
        options.tools.resize(trial_.tools, ToolSpec(options.tools[0]));
        options.faults.seed = trial_.seed + 1;
        return options;
    }

    [[nodiscard]] std::vector<Vec3> next_goals()
    {
        std::vector<Vec3> goals;
        for (PressMotion& motion : motions_)
        {
            goals.push_back(to_world(rig_.pose(), motion.next()));
        }
        return goals;
    }

    /// True if the answer is settled and the proxy moved as far as it needed, not just as far as
    /// the surface is known.
    [[nodiscard]] bool is_certified(const FrameRig& rig, const FrameOutput& output,
                                    std::uint32_t tool) const
    {
        const PairOutput& pair = output.pairs[tool];
        const std::span<const Vec3> path = rig.frame().tool(tool).path_m();
        const double end_m = (path.back() - path.front()).norm() + radius_m();
        const double known_m = std::max(pair.certified_radius_m, pair.lower_m);
        return (pair.kind == AnswerKind::exact || pair.kind == AnswerKind::separated) &&
               known_m - end_m > kStepEnd_m + kStepEnd * radius_m();
    }

    void judge(std::uint32_t tool, const FrameOutput& ours, const FrameOutput& full,
               const Vec3& goal_m)
    {
        const ToolOutput& a = ours.tools[tool];
        const ToolOutput& b = full.tools[tool];
        figures_.fading += a.halted || a.over_constrained ? 1 : 0;
        judge_wait(tool, a, goal_m);
        const bool is_answered = is_certified(rig_, ours, tool) &&
                                 is_certified(whole_, full, tool) && !a.under_way && !b.under_way;
        const std::optional<ForceStepJudge::Step> step = judges_[tool].judge(a, b, is_answered);
        if (!step)
        {
            return;
        }
        if (!step->is_certified)
        {
            ++figures_.data_limited;
            figures_.data_limited_n = std::max(figures_.data_limited_n, step->newtons);
            return;
        }
        ++figures_.steps.trials;
        figures_.steps.observe(step->newtons);
        figures_.apart_n = std::max(figures_.apart_n, (a.force_n - b.force_n).norm());
        figures_.refining += ours.work.splits > 0 ? 1 : 0;
        figures_.coarsening += ours.work.merges > 0 ? 1 : 0;
        figures_.adopting += ours.work.pages_adopted > 0 ? 1 : 0;
        if (step->newtons > kForceStep_n)
        {
            flag(tool, ours, full, goal_m, step->newtons);
        }
    }

    /// A force after a wait continues from its last value: the hand's motion changes it by the
    /// spring at most.
    void judge_wait(std::uint32_t tool, const ToolOutput& now, const Vec3& goal_m)
    {
        Last& last = last_[tool];
        if (last.has_waited && touches(now))
        {
            const double by_device_n = ToolSpec{}.stiffness_n_per_m * (goal_m - last.goal_m).norm();
            const double step_n = (now.force_n - last.force_n).norm() - by_device_n;
            ++figures_.after_waits.trials;
            figures_.after_waits.observe(std::max(0.0, step_n));
            if (step_n > kForceStep_n)
            {
                figures_.after_waits.flag(
                    figures_.after_waits.name + ", TACTUS_SEED=" + std::to_string(trial_.seed) +
                    ", frame " + std::to_string(frame_) + " (" + motions_[tool].activity() +
                    "): step of " + std::to_string(step_n) + " N; force " + text_of(last.force_n) +
                    ", then " + text_of(now.force_n));
            }
        }
        last = {now.force_n, goal_m, now.halted || now.over_constrained || now.data_limited};
    }

    void flag(std::uint32_t tool, const FrameOutput& ours, const FrameOutput& full,
              const Vec3& goal_m, double step_n)
    {
        const ToolOutput& a = ours.tools[tool];
        const ToolOutput& b = full.tools[tool];
        figures_.steps.flag(figures_.steps.name + ", TACTUS_SEED=" + std::to_string(trial_.seed) +
                            ", frame " + std::to_string(frame_) + " (" + motions_[tool].activity() +
                            "): step of " + std::to_string(step_n) + " N; goal " + text_of(goal_m) +
                            ", proxy " + text_of(a.proxy_m) + ", twin's " + text_of(b.proxy_m) +
                            ", force " + text_of(a.force_n) + ", twin's " + text_of(b.force_n) +
                            ", faults " + std::to_string(static_cast<std::uint32_t>(ours.faults)) +
                            ", answer " + std::to_string(static_cast<int>(ours.pairs[tool].kind)) +
                            ", certified " + std::to_string(ours.pairs[tool].certified_radius_m) +
                            ", twin's " + std::to_string(full.pairs[tool].certified_radius_m));
    }

    struct Last
    {
        Vec3 force_n{0.0, 0.0, 0.0};
        Vec3 goal_m{0.0, 0.0, 0.0};
        bool has_waited{false};
    };

    const ForceTwinTrial& trial_;
    Random random_;
    double diagonal_m_;
    FrameRig rig_;
    FrameRig whole_;
    std::vector<PressMotion> motions_;
    std::vector<ForceStepJudge> judges_;
    std::vector<Last> last_;
    ForceTwinFigures figures_;
    std::uint32_t frame_{0};
};

} // namespace

std::optional<ForceStepJudge::Step> ForceStepJudge::judge(const ToolOutput& ours,
                                                          const ToolOutput& twins, bool is_answered)
{
    const Vec3 change = ours.force_n - ours_n_;
    const Vec3 twins_change = twins.force_n - twins_n_;
    const bool are_touching = touches(ours) && touches(twins);
    const bool are_certified = are_touching && is_answered;
    std::optional<Step> step;
    if (were_touching_ && are_touching)
    {
        step =
            Step{(change - twins_change).norm(), were_certified_ && are_certified && !are_apart_};
    }
    const bool are_together = (ours.proxy_m - twins.proxy_m).norm() <= kTogether_m &&
                              (ours.force_n - twins.force_n).norm() <= kTogether_n;
    are_apart_ = !are_together && (are_apart_ || !are_certified);
    ours_n_ = ours.force_n;
    twins_n_ = twins.force_n;
    were_touching_ = are_touching;
    were_certified_ = are_certified;
    return step;
}

std::vector<Hardship> force_hardships(const TestModel& model)
{
    std::vector<Hardship> chosen;
    for (const char* name : {"usual", "point", "K-1", "K-4", "small-pools", "few-pages", "no-cache",
                             "lossy-link", "late-link"})
    {
        Hardship& hardship = chosen.emplace_back(hardship_named(model, name));
        hardship.radius_diag = hardship.radius_diag > 0.0 ? kPressedRadius_diag : 0.0;
        hardship.rig.cache_bytes =
            std::min(hardship.rig.cache_bytes, std::size_t{1}) * kCache_bytes;
    }
    return chosen;
}

ForceTwinFigures run_force_twin_trial(const ForceTwinTrial& trial)
{
    return ForceTwinRun(trial).run();
}

} // namespace tactus::test
