// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/greedy_tools.hpp"

#include "tests/shared/face_tree.hpp"
#include "tests/shared/frame_verdict.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/surface_slide.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::test
{

namespace
{

using Others = GreedyCase::Others;

constexpr double kRadius_diag = 0.01;
constexpr double kOwnSpeed_diag_per_s = 0.5;
constexpr double kPeriod_s = 0.001;
constexpr std::uint32_t kLeadFrames = 500;
constexpr std::uint32_t kTeleportFrames = 10;
constexpr std::size_t kMiB = std::size_t{1} << 20U;
/// Distance between the centres of neighbours: none touches another.
constexpr double kApart_diag = 1.5;

SlideManner manner_of(const TestModel& model, double speed_diag_per_s, std::uint64_t seed)
{
    SlideManner manner;
    manner.diagonal_m = model.diagonal_m;
    manner.radius_diag = kRadius_diag;
    manner.step_m = speed_diag_per_s * kPeriod_s * model.diagonal_m;
    manner.rotation_rate = [seed](std::uint64_t turn)
    { return Random::seeded(1'000 * seed + turn).between(-1.0, 1.0); };
    return manner;
}

Vec3 somewhere(const TestModel& model, Random& random)
{
    return to_vec3(model.faces[random.below(static_cast<std::uint32_t>(model.faces.size()))][0]);
}

/// Translation of an object's model relative to the first.
Vec3 place_of(const TestModel& model, const GreedyCase& greedy, std::uint32_t object)
{
    const auto side = static_cast<std::uint32_t>(std::ceil(std::sqrt(greedy.objects)));
    return kApart_diag * model.diagonal_m * Vec3(object % side, object / side, 0.0);
}

std::uint32_t others_of(const GreedyCase& greedy)
{
    return greedy.others == Others::none ? 0 : greedy.tools;
}

RigOptions options_of(const TestModel& model, const GreedyCase& greedy)
{
    RigOptions options;
    options.pool_bytes = greedy.all_resident ? 128 * kMiB : greedy.pool_bytes;
    ToolSpec own;
    own.radius_m = kRadius_diag * model.diagonal_m;
    own.speed_max_m_per_s = 1.5 * kOwnSpeed_diag_per_s * model.diagonal_m;
    options.tools = {own};
    for (std::uint32_t i = 0; i < others_of(greedy); ++i)
    {
        ToolSpec other = own;
        other.query_only = greedy.others != Others::are_held;
        other.speed_max_m_per_s = other.query_only ? 10.0 : greedy.follow_m_per_s;
        options.tools.push_back(other);
    }
    for (std::uint32_t i = 0; i < greedy.objects; ++i)
    {
        options.objects.push_back({ModelId{i % greedy.models}});
        options.poses.emplace_back();
        options.poses.back().translation_m = place_of(model, greedy, i);
    }
    options.chunk_loader_steps_per_frame = 1;
    options.faults.delay_polls_min = options.faults.delay_polls_max = 10;
    return options;
}

/// Hand positions, frame by frame; the first does not depend on the others.
class GreedyOperators
{
public:
    GreedyOperators(const TestModel& model, const GreedyCase& greedy, std::uint64_t seed)
        : model_(model)
        , greedy_(greedy)
        , tree_(model.faces)
        , random_(Random::seeded(seed))
        , goals_(1 + others_of(greedy))
    {
        for (std::size_t i = 0; i < goals_.size(); ++i)
        {
            const double speed = i == 0 ? kOwnSpeed_diag_per_s : greedy.operators_diag_per_s;
            slides_.emplace_back(tree_, manner_of(model, speed, seed + i),
                                 somewhere(model, random_));
        }
    }
    GreedyOperators(const GreedyOperators&) = delete; // Slides keep the tree's address.
    GreedyOperators& operator=(const GreedyOperators&) = delete;

    const std::vector<Vec3>& next()
    {
        goals_[0] = slides_[0].next();
        for (std::uint32_t i = 1; i < goals_.size(); ++i)
        {
            if (greedy_.others != Others::teleport)
            {
                goals_[i] = slides_[i].next() + place(i % greedy_.objects);
            }
            else if (frame_ % kTeleportFrames == 0)
            {
                goals_[i] = somewhere(model_, random_);
                goals_[i] += place(greedy_.objects > 1 ? random_.below(greedy_.objects) : 0);
            }
        }
        ++frame_;
        return goals_;
    }

private:
    [[nodiscard]] Vec3 place(std::uint32_t object) const
    {
        return place_of(model_, greedy_, object);
    }

    const TestModel& model_;
    const GreedyCase& greedy_;
    FaceTree tree_;
    Random random_;
    std::vector<SurfaceSlide> slides_;
    std::vector<Vec3> goals_;
    std::uint32_t frame_{0};
};

} // namespace

const std::vector<GreedyCase>& greedy_cases()
{
    static const std::vector<GreedyCase> cases{
        {"alone", Others::none, 0.0, 0.0, 64},
        {"pass, 1 diag/s, K 16", Others::pass, 1.0, 0.0, 16},
        {"pass, 2 diag/s, K 16", Others::pass, 2.0, 0.0, 16},
        {"pass, 4 diag/s, K 16", Others::pass, 4.0, 0.0, 16},
        {"pass, 4 diag/s, K 64", Others::pass, 4.0, 0.0, 64},
        {"teleport, K 64", Others::teleport, 0.0, 0.0, 64},
        {"teleport, all resident, K 16", Others::teleport, 0.0, 0.0, 16, 0, true},
        {"held, 2 m/s, hands 8 diag/s, K 64", Others::are_held, 8.0, 2.0, 64},
        {"held, 2 m/s, hands 4 diag/s, K 16", Others::are_held, 4.0, 2.0, 16},
        {"held, 0.5 m/s, hands 4 diag/s, K 16", Others::are_held, 4.0, 0.5, 16},
        {"held, 0.05 m/s, hands 4 diag/s, K 16", Others::are_held, 4.0, 0.05, 16},
        {"pass, 4 diag/s, K 64, 2 MiB", Others::pass, 4.0, 0.0, 64, 2 * kMiB},
        {"4 tools teleport on 4 models, K 64", Others::teleport, 0.0, 0.0, 64, 8 * kMiB, false, 4,
         4, 4},
    };
    return cases;
}

GreedyFigures run_greedy(const TestModel& model, const GreedyCase& greedy, std::uint32_t frames,
                         std::uint64_t seed)
{
    FrameRig rig(std::vector(greedy.models, &model), options_of(model, greedy));
    GreedyOperators hands(model, greedy, seed);
    if (greedy.all_resident)
    {
        load_everything(rig);
    }
    Budgets budgets;
    budgets.splits = budgets.merges = greedy.splits;
    GreedyFigures figures;
    Vec3 last_force(0.0, 0.0, 0.0);
    for (std::uint32_t frame = 0; frame < kLeadFrames + frames; ++frame)
    {
        const FrameOutput output = rig.step(hands.next(), budgets);
        if (const Verdict verdict = broken_budget(output, budgets);
            verdict && figures.broken.empty())
        {
            figures.broken = *verdict;
        }
        const ToolOutput& own = output.tools[0];
        const double step_n = (own.force_n - last_force).norm();
        last_force = own.force_n;
        if (frame < kLeadFrames)
        {
            continue;
        }
        figures.splits_max = std::max(figures.splits_max, output.work.splits);
        figures.force_step_n = std::max(figures.force_step_n, step_n);
        figures.shed += has_fault(output.faults, FrameFault::pair_shed) ? 1U : 0U;
        figures.full += has_fault(output.faults, FrameFault::cache_full | FrameFault::forest_full |
                                                     FrameFault::tree_full)
                            ? 1U
                            : 0U;
        if (SurfaceSlide::wanted_distance_diag(kRadius_diag, frame) < kRadius_diag)
        {
            ++figures.frames;
            figures.exact += output.pairs[0].kind == AnswerKind::exact ? 1U : 0U;
            figures.data_limited += own.data_limited ? 1U : 0U;
        }
    }
    return figures;
}

} // namespace tactus::test
