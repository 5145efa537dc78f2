// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/stability/scene_trial.hpp"

#include "tests/shared/face_tree.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/random.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <utility>

namespace tactus::test
{

namespace
{

constexpr double kRounding_m = 1e-14;
constexpr double kClearRounding_m = 1e-12;
constexpr std::uint32_t kScenePlaces = 24;  ///< Places of objects.
constexpr std::uint32_t kRoundFrames = 250; ///< Frames of one scene.

/// State of the scene as its author knows it.
class Known
{
public:
    struct Thing
    {
        std::uint32_t generation{0};
        ModelId model{};
        ObjectPose pose; ///< Pose of the model frame.
    };

    Known(const std::vector<const TestModel*>& models, std::uint32_t tools)
        : tools_here(tools, true)
    {
        for (const TestModel* model : models)
        {
            trees_.emplace_back(model->faces);
        }
    }

    /// Distance of a place from the nearest face of an object.
    [[nodiscard]] long double distance(const Thing& thing, const Vec3& world_m) const
    {
        const Vec3 place = to_model(thing.pose, world_m);
        const auto wide = [](double value) { return static_cast<long double>(value); };
        return trees_[thing.model.value]
                   .wide_nearest({wide(place.x()), wide(place.y()), wide(place.z())})
                   .distance_m *
               wide(thing.pose.scale);
    }

    [[nodiscard]] std::uint32_t models() const { return static_cast<std::uint32_t>(trees_.size()); }

    std::map<std::uint32_t, Thing> things;
    std::vector<bool> tools_here;

private:
    std::vector<FaceTree> trees_;
};

/// Events of a scene, frame by frame, the same for each rig.
class Story
{
public:
    Story(const Random& random, double diagonal_m, std::uint32_t tools)
        : random_(random), diagonal_m_(diagonal_m), goals_(tools)
    {
        for (Vec3& goal : goals_)
        {
            goal = random_.in_cube(world_m());
        }
    }

    /// Makes valid changes and ones that must be refused, and counts the latter.
    void tell(Known& known, const std::function<void(const SceneChange&)>& change)
    {
        refused_.fill(0);
        const std::uint32_t changes = random_.below(4U);
        for (std::uint32_t i = 0; i < changes; ++i)
        {
            change(random_.one_in(10) ? next_of_tool(known) : next(known));
        }
    }
    [[nodiscard]] const std::vector<Vec3>& move()
    {
        for (Vec3& goal : goals_)
        {
            goal += 0.004 * random_.in_cube(diagonal_m_);
            if (random_.one_in(200))
            {
                goal = random_.in_cube(world_m());
            }
        }
        return goals_;
    }
    [[nodiscard]] const std::array<std::uint32_t, kChangeRefusals>& refused() const
    {
        return refused_;
    }

private:
    [[nodiscard]] double world_m() const { return 1.5 * diagonal_m_; }
    void refuse(ChangeRefusal refusal) { ++refused_[static_cast<std::size_t>(refusal)]; }

    /// Change of a tool, with one number more than there are tools.
    SceneChange next_of_tool(Known& known)
    {
        SceneChange change;
        change.number = random_.below(static_cast<std::uint32_t>(goals_.size()) + 1);
        const bool comes = random_.one_in(2);
        change.kind = comes ? SceneChangeKind::tool_comes : SceneChangeKind::tool_goes;
        if (change.number == goals_.size())
        {
            refuse(ChangeRefusal::number_too_big);
        }
        else if (known.tools_here[change.number] == comes)
        {
            refuse(comes ? ChangeRefusal::already_here : ChangeRefusal::not_here);
        }
        else
        {
            known.tools_here[change.number] = comes;
        }
        return change;
    }

    SceneChange next(Known& known)
    {
        SceneChange change;
        change.number = random_.below(kScenePlaces);
        change.pose = any_pose(random_, world_m());
        const auto at = known.things.find(change.number);
        if (at == known.things.end())
        {
            std::uint32_t& generation = generations_[change.number];
            change.kind = SceneChangeKind::object_comes;
            change.object = {ModelId{random_.below(known.models())}, {400.0, 0.3, 0.2, 0.0}};
            change.generation = generation;
            if (random_.one_in(8) && generation > 0)
            {
                --change.generation;
                refuse(ChangeRefusal::old_generation);
                return change;
            }
            ++generation;
            known.things[change.number] = {change.generation, change.object.model, change.pose};
            return change;
        }
        Known::Thing& thing = at->second;
        change.generation = thing.generation;
        switch (random_.below(8U))
        {
        case 0:
            change.kind = SceneChangeKind::object_goes;
            known.things.erase(at);
            return change;
        case 1:
            change.kind = SceneChangeKind::object_comes;
            change.object.model = thing.model;
            refuse(ChangeRefusal::already_here);
            return change;
        case 2:
            ++change.generation;
            refuse(ChangeRefusal::old_generation);
            return change;
        case 3:
            change.pose.scale = 0.0;
            refuse(ChangeRefusal::bad_pose);
            return change;
        case 4: // Move to any place.
            thing.pose = change.pose;
            return change;
        default: // Small move.
            change.pose = thing.pose;
            change.pose.translation_m += 0.01 * random_.in_cube(diagonal_m_);
            thing.pose = change.pose;
            return change;
        }
    }

    Random random_;
    double diagonal_m_;
    std::vector<Vec3> goals_;
    /// Next generation of each number; the first object is there from the start.
    std::map<std::uint32_t, std::uint32_t> generations_{{0, 1}};
    std::array<std::uint32_t, kChangeRefusals> refused_{};
};

/// Checks all places and distances that a frame reports.
class SceneJudge
{
public:
    SceneJudge(const Known& known, SceneFigures& figures) : known_(known), figures_(figures) {}

    void judge(const FrameRig& rig, const FrameOutput& output, const Story& story,
               const std::string& where)
    {
        TrialFigures& truth = figures_.truth;
        ++truth.trials;
        if (output.scene.objects != known_.things.size() ||
            output.scene.pairs != output.pairs.size() || output.scene.refused != story.refused())
        {
            truth.flag(where + ": another number of objects, pairs or refused changes");
        }
        if (!std::ranges::is_sorted(output.pairs, {},
                                    [](const PairOutput& pair)
                                    { return std::pair(pair.tool, pair.object); }))
        {
            truth.flag(where + ": pairs out of order");
        }
        for (std::uint32_t i = 0; i < output.tools.size(); ++i)
        {
            if (output.tools[i].is_gone == known_.tools_here[i])
            {
                truth.flag(where + ", tool " + std::to_string(i) + ": is here, or isn't");
            }
            known_.tools_here[i] ? judge_tool(rig, output, i, where)
                                 : judge_absent(output, i, where);
        }
        figures_.exact += static_cast<std::uint64_t>(
            std::ranges::count(output.pairs, AnswerKind::exact, &PairOutput::kind));
        for (const std::uint32_t refused : output.scene.refused)
        {
            figures_.refused += refused;
        }
    }

private:
    void judge_tool(const FrameRig& rig, const FrameOutput& output, std::uint32_t tool,
                    const std::string& where)
    {
        const Vec3 center = rig.frame().tool(tool).placement().place.translation_m;
        std::size_t near = 0;
        for (const auto& entry : known_.things)
        {
            const std::uint32_t number = entry.first;
            const long double truth_m = known_.distance(entry.second, center);
            const std::string what =
                where + ", tool " + std::to_string(tool) + " to " + std::to_string(number);
            const auto pair =
                std::ranges::find_if(output.pairs, [tool, number](const PairOutput& one)
                                     { return one.tool == tool && one.object == number; });
            if (pair == output.pairs.end())
            {
                observe(static_cast<long double>(output.tools[tool].clear_m) - truth_m,
                        kClearRounding_m, what + ": not as clear as said");
                continue;
            }
            ++near;
            if ((pair->point_m - center).norm() > kRounding_m)
            {
                figures_.truth.flag(what + ": asked at another place");
            }
            observe(static_cast<long double>(pair->lower_m) - truth_m, kRounding_m,
                    what + ": nearer than said");
            observe(truth_m - static_cast<long double>(pair->upper_m), kRounding_m,
                    what + ": farther than said");
        }
        if (near == 0 && !known_.things.empty())
        {
            figures_.truth.flag(where + ": a tool without a pair");
        }
    }
    void judge_absent(const FrameOutput& output, std::uint32_t tool, const std::string& where)
    {
        ++figures_.gone;
        if (output.tools[tool].force_n != Vec3(0.0, 0.0, 0.0) ||
            std::ranges::count(output.pairs, tool, &PairOutput::tool) > 0)
        {
            figures_.truth.flag(where + ": force or pairs of a tool that is gone");
        }
    }
    void observe(long double beyond_m, double allowed_m, const std::string& text)
    {
        const auto error = static_cast<double>(beyond_m) / allowed_m;
        figures_.truth.observe(error);
        if (!(error <= 1.0))
        {
            figures_.truth.flag(text);
        }
    }

    const Known& known_;
    SceneFigures& figures_;
};

/// Runs a new scene from frame `first` of the trial.
void run_round(const SceneTrial& trial, std::uint32_t first, SceneFigures& figures)
{
    const double diagonal_m = trial.models[0]->diagonal_m;
    const std::uint64_t seed = trial.seed + first;
    Random random = Random::seeded(seed);
    RigOptions options = trial.hardship.rig;
    options.tools.assign(trial.tools, ToolSpec{0.01 * diagonal_m, 500.0, 8.0, 1.0});
    options.capacities.objects = kScenePlaces;
    if (!random.one_in(4))
    {
        options.variant = any_variant(random);
        ++figures.variants;
    }
    FrameRig rig(trial.models, options);
    Known known(trial.models, trial.tools);
    known.things[0] = {0, ModelId{0}, {}};
    Story story(random, diagonal_m, trial.tools);
    SceneJudge judge(known, figures);
    for (std::uint32_t frame = 0; frame < std::min(trial.frames - first, kRoundFrames); ++frame)
    {
        story.tell(known, [&rig](const SceneChange& change) { rig.change(change); });
        const FrameOutput output = rig.step(story.move(), trial.hardship.budgets);
        judge.judge(rig, output, story,
                    "seed " + std::to_string(seed) + ", frame " + std::to_string(frame));
    }
}

} // namespace

ObjectPose any_pose(Random& random, double world_m)
{
    ObjectPose pose;
    pose.rotation = Eigen::AngleAxisd{random.between(0.0, 3.0), random.in_cube(1.0).normalized()}
                        .toRotationMatrix();
    pose.translation_m = random.in_cube(world_m);
    pose.scale = random.between(0.5, 1.5);
    return pose;
}

FrameVariant any_variant(Random& random)
{
    FrameVariant variant;
    for (bool FrameVariant::*const shortcut :
         {&FrameVariant::finds_neighbours, &FrameVariant::lets_tools_rest,
          &FrameVariant::lets_frames_rest, &FrameVariant::lets_pairs_rest,
          &FrameVariant::starts_warm, &FrameVariant::keeps_certificates,
          &FrameVariant::refits_changed_only, &FrameVariant::asks_near_models_only,
          &FrameVariant::keeps_searches, &FrameVariant::asks_ahead})
    {
        variant.*shortcut = random.one_in(2);
    }
    return variant;
}

SceneFigures run_scene_trial(const SceneTrial& trial)
{
    SceneFigures figures;
    figures.truth.name = std::string("scene, ") + trial.hardship.name;
    figures.truth.unit = "of the rounding allowed";
    for (std::uint32_t frame = 0; frame < trial.frames; frame += kRoundFrames)
    {
        run_round(trial, frame, figures);
    }
    return figures;
}

} // namespace tactus::test
