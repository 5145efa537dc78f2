// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/stability/day_trial.hpp"

#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/forest/vertex_forest.hpp"
#include "rt_core/limits.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/loaded_forest.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/surface_slide.hpp"
#include "tests/shared/validate_tree.hpp"
#include "tests/stability/trial_terms.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace tactus::test
{

namespace
{

/// State that must recur whenever nothing is refined.
struct RestState
{
    std::uint64_t hash{0};
    std::uint32_t refined{0};
    std::uint32_t faces{0};
    std::uint32_t blocks{0};
    std::uint32_t nodes{0};

    /// True if the state of the start recurs. Blocks merge later than they split, so that a face
    /// that flickers moves nothing; their number depends on the history but must not grow without
    /// bound.
    [[nodiscard]] bool is_again(const RestState& start) const
    {
        return hash == start.hash && refined == start.refined && faces == start.faces &&
               blocks <= 2 * start.blocks && nodes <= 2 * start.nodes;
    }
};

RestState state_of(const VertexForest& forest, const AbTree& tree)
{
    return {forest.state_hash(), forest.refined_records(), forest.active_faces(),
            tree.blocks_used(), tree.nodes_used()};
}

std::string describe(const RestState& now, const RestState& start)
{
    const auto one = [](const RestState& state)
    {
        return "hash " + std::to_string(state.hash) + ", records " + std::to_string(state.refined) +
               ", faces " + std::to_string(state.faces) + ", blocks " +
               std::to_string(state.blocks) + ", nodes " + std::to_string(state.nodes);
    };
    return one(now) + "; at the start " + one(start);
}

constexpr std::size_t kPlaces = 8; ///< Number of different touches.

/// One touch: descent from afar, slide, press, retreat and rest.
struct Touch
{
    std::vector<Vec3> goals;
    std::size_t press_begin{0}; ///< First frame of the still goal, which ends at `press_end`.
    std::size_t press_end{0};
};

void go(std::vector<Vec3>& goals, const Vec3& to, std::size_t frames)
{
    const Vec3 from = goals.back();
    for (std::size_t i = 1; i <= frames; ++i)
    {
        goals.emplace_back(from +
                           (to - from) * (static_cast<double>(i) / static_cast<double>(frames)));
    }
}

Touch touch_at(const TestModel& model, const FaceTree& tree, const Vec3& rest, Random& random)
{
    const double diag = model.diagonal_m;
    SlideManner manner;
    manner.diagonal_m = diag;
    manner.radius_diag = kRadius_diag;
    manner.step_m = random.between(0.05e-3, 0.5e-3) * diag;
    manner.rotation_rate = [rate = random.between(-1.0, 1.0)](std::uint64_t) { return rate; };
    const Vec3 corner = to_vec3(model.faces[random.below(model.faces.size())][0]);
    // The descent is radial from the distance of the rest, so that nothing is in the way.
    const Vec3 middle = 0.5 * (tree.low_m() + tree.high_m());
    const Vec3 outward = (corner - middle).normalized();
    const Vec3 above = middle + (rest - middle).norm() * outward;
    SurfaceSlide slide(tree, manner, corner + 0.02 * diag * outward);
    Touch touch;
    touch.goals = {rest};
    go(touch.goals, above, 200);
    go(touch.goals, slide.next(), 300);
    for (int i = 0; i < 600; ++i)
    {
        touch.goals.push_back(slide.next());
    }
    // The goal is a third of the radius deep in the surface.
    const Vec3 foot = tree.nearest(touch.goals.back()).point_m;
    const Vec3 inward = (foot - touch.goals.back()).normalized();
    go(touch.goals, foot - 0.67 * kRadius_diag * diag * inward, 50);
    touch.press_begin = touch.goals.size();
    touch.goals.resize(touch.goals.size() + 200, touch.goals.back());
    touch.press_end = touch.goals.size();
    go(touch.goals, above, 200);
    go(touch.goals, rest, 200);
    touch.goals.resize(kTouchFrames, rest);
    return touch;
}

/// Frames until a pressed proxy is at rest.
constexpr std::size_t kSettling = 60;

/// Rig with its rest position and touches.
class Day
{
public:
    Day(const TestModel& model, std::uint64_t seed)
        : model_(model), tree_(model.faces), seed_(seed), rig_(model, {})
    {
        const Vec3 middle = 0.5 * (tree_.low_m() + tree_.high_m());
        rest_ = middle + Vec3(0.0, 0.0, 3.0 * model.diagonal_m);
        Random random = Random::seeded(seed);
        for (Touch& touch : touches_)
        {
            touch = touch_at(model, tree_, rest_, random);
        }
        figures_.returns = {model.name + ", returns to rest", 0, 0.0, 0.0, "other states", 0, {}};
        figures_.creep = creep_of(model);
    }

    [[nodiscard]] DayFigures run(std::uint32_t touches)
    {
        static_cast<void>(rig_.step(rest_));
        const RestState start = state_of(rig_.model().forest, rig_.model().tree);
        for (std::uint32_t i = 0; i < touches; ++i)
        {
            const ToolOutput rested = run_touch(touches_[i % kPlaces]);
            ++figures_.returns.trials;
            const RestState now = state_of(rig_.model().forest, rig_.model().tree);
            if (!now.is_again(start) || rested.proxy_m != rest_ || !rested.force_n.isZero(0.0))
            {
                figures_.returns.flag(
                    figures_.returns.name + ", TACTUS_SEED=" + std::to_string(seed_) + ", touch " +
                    std::to_string(i) + ": " + describe(now, start) + "; the proxy is " +
                    std::to_string((rested.proxy_m - rest_).norm()) + " m from the goal");
            }
        }
        figures_.returns.observe(static_cast<double>(figures_.returns.violations));
        figures_.simulated_s = static_cast<double>(figures_.frames) * 1e-3;
        return figures_;
    }

    [[nodiscard]] TrialFigures press(std::uint64_t frames)
    {
        const Touch& touch = touches_[0];
        for (std::size_t i = 0; i < touch.press_begin + kSettling; ++i)
        {
            static_cast<void>(rig_.step(touch.goals[i]));
        }
        const Vec3 settled = rig_.step(touch.goals[touch.press_begin]).tools[0].proxy_m;
        for (std::uint64_t i = 0; i < frames; ++i)
        {
            const ToolOutput tool = rig_.step(touch.goals[touch.press_begin]).tools[0];
            observe_creep(settled, tool);
        }
        figures_.creep.trials = frames;
        return figures_.creep;
    }

private:
    static TrialFigures creep_of(const TestModel& model)
    {
        return {model.name + ", pressed proxy", 0, 0.0, 1.0, "of the contact tolerance", 0, {}};
    }

    [[nodiscard]] ToolOutput run_touch(const Touch& touch)
    {
        ToolOutput tool;
        Vec3 settled(0.0, 0.0, 0.0);
        for (std::size_t i = 0; i < touch.goals.size(); ++i)
        {
            tool = rig_.step(touch.goals[i]).tools[0];
            if (i == touch.press_begin + kSettling)
            {
                settled = tool.proxy_m;
            }
            if (i + 1 == touch.press_end)
            {
                observe_creep(settled, tool);
                ++figures_.creep.trials;
            }
        }
        figures_.frames += touch.goals.size();
        return tool;
    }

    void observe_creep(const Vec3& settled, const ToolOutput& tool)
    {
        const double creep = (tool.proxy_m - settled).norm();
        const double share = creep / (kContactTolerance * kRadius_diag * model_.diagonal_m);
        figures_.creep.observe(share);
        if (share > 1.0 || !tool.in_contact)
        {
            figures_.creep.flag(figures_.creep.name + ", TACTUS_SEED=" + std::to_string(seed_) +
                                ": crept by " + std::to_string(share) + " tolerances, " +
                                (tool.in_contact ? "in contact" : "not in contact"));
        }
    }

    const TestModel& model_;
    FaceTree tree_;
    std::uint64_t seed_;
    FrameRig rig_;
    Vec3 rest_{0.0, 0.0, 0.0};
    std::array<Touch, kPlaces> touches_;
    DayFigures figures_;
};

constexpr std::uint32_t kWave = 50'000;   ///< Operations between two returns to the base.
constexpr std::uint32_t kRefitEvery = 64; ///< Operations between refits, as many as in a frame.

/// Compares the boxes, lists and links of the tree with the forest's faces.
std::string faults_of(LoadedForest& sut)
{
    std::vector<ChangedFace> faces;
    for (const PrimId prim : sut.active())
    {
        faces.push_back(sut.forest().describe(prim));
    }
    return tree_faults(sut.tree(), faces);
}

/// One operation, or several if a record depends on others; `grows` is the direction of the wave.
std::uint32_t change(LoadedForest& sut, bool grows, Random& random)
{
    const RecordId record = sut.random_record(random);
    if (sut.pages().is_refined(record))
    {
        return sut.forest().try_merge(record) ? 1 : 0;
    }
    return grows ? sut.split_with_dependencies(record) : 0;
}

std::uint32_t run_wave(LoadedForest& sut, Random& random)
{
    std::uint32_t operations = 0;
    std::uint32_t refitted = 0;
    // Fewer and fewer records can be merged in shrinking phases, so attempts are counted there.
    for (std::uint32_t attempt = 0; operations < kWave; ++attempt)
    {
        const bool grows = (attempt / 4'000) % 3 != 2;
        operations += change(sut, grows, random);
        if (operations - refitted >= kRefitEvery)
        {
            static_cast<void>(sut.tree().refit());
            refitted = operations;
        }
    }
    return operations;
}

} // namespace

DayFigures run_day_trial(const TestModel& model, std::uint32_t touches, std::uint64_t seed)
{
    return Day(model, seed).run(touches);
}

TrialFigures run_press_trial(const TestModel& model, std::uint64_t frames, std::uint64_t seed)
{
    return Day(model, seed).press(frames);
}

TrialFigures run_split_merge_trial(const TestModel& model, std::uint64_t operations,
                                   std::uint64_t seed)
{
    TrialFigures figures;
    figures.name = model.name + ", splits and merges";
    figures.bound = 0.0;
    figures.unit = "returns to another state";
    Random random = Random::seeded(seed);
    LoadedForest sut(model);
    static_cast<void>(sut.tree().refit());
    const RestState start = state_of(sut.forest(), sut.tree());
    while (figures.trials < operations)
    {
        figures.trials += run_wave(sut, random);
        figures.trials += sut.merge_everything(random);
        static_cast<void>(sut.tree().refit());
        const RestState now = state_of(sut.forest(), sut.tree());
        if (const std::string faults = faults_of(sut); !now.is_again(start) || !faults.empty())
        {
            figures.flag(figures.name + ", TACTUS_SEED=" + std::to_string(seed) + ", after " +
                         std::to_string(figures.trials) + ": " + describe(now, start) + faults);
            figures.observe(static_cast<double>(figures.violations));
        }
    }
    return figures;
}

} // namespace tactus::test
