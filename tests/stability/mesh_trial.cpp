// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/stability/mesh_trial.hpp"

#include "tests/shared/frame_verdict.hpp"
#include "tests/stability/mesh_judge.hpp"
#include "tests/stability/same_bits.hpp"
#include "tests/stability/whole_model.hpp"

#include <algorithm>
#include <memory>

namespace tactus::test
{

namespace
{

double skin_m(const MeshTrial& trial)
{
    return trial.hardship.radius_diag * trial.tool.diagonal_m;
}

RigOptions rig_options(const MeshTrial& trial)
{
    RigOptions options = trial.hardship.rig;
    options.pool_bytes *= 2;
    options.faults.seed = trial.seed + 1;
    ToolSpec tool;
    tool.radius_m = skin_m(trial);
    tool.core = MeshCore{ModelId{1}};
    tool.wants_contacts = true;
    tool.wants_pairs = true;
    tool.query_only = true; // A tool with a proxy would never meet the object.
    options.tools = {tool};
    return options;
}

FrameOutput step(FrameRig& rig, const MeshMoment& moment, const Budgets& budgets)
{
    rig.place_object(moment.pose);
    return rig.step(std::span(&moment.tool, 1), budgets);
}

std::string name_of(const MeshTrial& trial)
{
    return trial.tool.name + " on " + trial.object.name + ", " + trial.hardship.name;
}

std::string where(const MeshTrial& trial, std::uint32_t frame, const char* activity)
{
    return name_of(trial) + ", TACTUS_SEED=" + std::to_string(trial.seed) + ", frame " +
           std::to_string(frame) + " (" + activity + "): ";
}

bool is_answered(const PairOutput& pair)
{
    return pair.kind == AnswerKind::exact || pair.kind == AnswerKind::separated;
}

/// Frames of one trial and their evaluation.
class MeshRun
{
public:
    MeshRun(const MeshTrial& trial, MeshMotion& motion)
        : trial_(trial)
        , motion_(motion)
        , rig_({&trial.object, &trial.tool}, rig_options(trial))
        , judge_(trial.tool, trial.object, skin_m(trial))
    {
        figures_.truth = {name_of(trial), 0, 0.0, 0.0, "frames", 0, {}};
        figures_.open = {name_of(trial) + ", open", 0, 0.0, kMeshOpenShare, "of the frames", 0, {}};
    }

    [[nodiscard]] MeshFigures run()
    {
        for (frame_ = 0; frame_ < trial_.frames; ++frame_)
        {
            const MeshMoment moment = motion_.next();
            const FrameOutput output = step(rig_, moment, trial_.hardship.budgets);
            count(output.pairs[0]);
            check(output, moment);
        }
        if (figures_.open.trials > 0)
        {
            figures_.open.observe(static_cast<double>(open_) /
                                  static_cast<double>(figures_.open.trials));
        }
        return figures_;
    }

private:
    void count(const PairOutput& pair)
    {
        const bool is_complete = pair.mesh != nullptr && pair.mesh->is_complete;
        figures_.exact += pair.kind == AnswerKind::exact ? 1U : 0U;
        figures_.complete += is_complete ? 1U : 0U;
        figures_.truncated += pair.mesh != nullptr && pair.mesh->is_truncated ? 1U : 0U;
        if (frame_ >= kMeshSettling)
        {
            ++figures_.open.trials;
            open_ += is_answered(pair) && is_complete ? 0U : 1U;
        }
    }

    void check(const FrameOutput& output, const MeshMoment& moment)
    {
        ++figures_.truth.trials;
        std::vector<std::string> wrong = judge_.judge(rig_, moment, output.pairs[0]);
        motion_.feel(judge_.distance_m());
        figures_.meeting += judge_.is_meeting() ? 1U : 0U;
        for (const Verdict& verdict :
             {broken_budget(output, trial_.hardship.budgets), unexplained(output)})
        {
            if (verdict)
            {
                wrong.push_back(*verdict);
            }
        }
        for (const std::string& what : wrong)
        {
            figures_.truth.flag(where(trial_, frame_, motion_.activity()) + what);
        }
        wrong_frames_ += wrong.empty() ? 0 : 1;
        figures_.truth.observe(wrong_frames_);
    }

    const MeshTrial& trial_;
    MeshMotion& motion_;
    FrameRig rig_;
    MeshJudge judge_;
    MeshFigures figures_;
    std::uint32_t frame_{0};
    std::uint64_t open_{0};
    int wrong_frames_{0};
};

/// Difference between two exact answers; empty if there is none.
std::string difference(const PairOutput& a, const PairOutput& b)
{
    if (!same_bits(a.lower_m, b.lower_m) || !same_bits(a.upper_m, b.upper_m))
    {
        return "the distances differ: " + std::to_string(a.lower_m) + ", whole " +
               std::to_string(b.lower_m);
    }
    if (a.mesh->is_complete && b.mesh->is_complete &&
        !std::equal(a.mesh->meeting.begin(), a.mesh->meeting.end(), b.mesh->meeting.begin(),
                    b.mesh->meeting.end()))
    {
        return "the faces that meet differ";
    }
    if (a.contacts->is_complete && b.contacts->is_complete &&
        !same_bits(a.contacts->contacts, b.contacts->contacts))
    {
        return "the contacts differ";
    }
    // Any of several meeting faces is nearest, and the known ones may differ.
    const bool is_known = a.upper_m > 0.0 || (a.mesh->is_complete && b.mesh->is_complete);
    if (is_known &&
        (a.nearest_face != b.nearest_face ||
         a.mesh->nearest_tool_face != b.mesh->nearest_tool_face ||
         !same_bits(a.point_m, b.point_m) || !same_bits(a.nearest_point_m, b.nearest_point_m)))
    {
        return "the nearest faces or points differ";
    }
    return "";
}

/// Rig with both models refined fully.
std::unique_ptr<FrameRig> whole_models(const MeshTrial& trial)
{
    RigOptions options = whole_options(trial.object.faces.size() + trial.tool.faces.size());
    options.pool_bytes *= 2;
    options.tools = rig_options(trial).tools;
    auto rig = std::make_unique<FrameRig>(std::vector{&trial.object, &trial.tool}, options);
    refine_fully(name_of(trial),
                 [&](const Budgets& budgets) { return step(*rig, MeshMoment{}, budgets); });
    return rig;
}

/// Rig of a tool that requests no contacts, and all pairs or none.
std::unique_ptr<FrameRig> rig_without_contacts(const MeshTrial& trial, bool wants_pairs)
{
    RigOptions options = rig_options(trial);
    options.tools[0].wants_contacts = false;
    options.tools[0].wants_pairs = wants_pairs;
    return std::make_unique<FrameRig>(std::vector{&trial.object, &trial.tool}, options);
}

/// Difference between answers with and without pairs; empty if there is none.
std::string difference_without_pairs(const PairOutput& all, const PairOutput& first)
{
    // Bounds beyond the reach depend on the pair's memory.
    const bool are_exact = all.kind == AnswerKind::exact && first.kind == AnswerKind::exact;
    if (are_exact &&
        (!same_bits(all.lower_m, first.lower_m) || !same_bits(all.upper_m, first.upper_m)))
    {
        return "the distances differ: " + std::to_string(first.lower_m) + ", with pairs " +
               std::to_string(all.lower_m);
    }
    const bool are_known = all.mesh->intersection != Intersection::open &&
                           first.mesh->intersection != Intersection::open;
    if (are_known && all.mesh->intersection != first.mesh->intersection)
    {
        return "whether they meet differs";
    }
    if (first.mesh->intersection == Intersection::proven && first.kind != AnswerKind::exact)
    {
        return "they meet, and the distance is not known";
    }
    if (first.mesh->meeting.size() > 1)
    {
        return "pairs that nobody wants: " + std::to_string(first.mesh->meeting.size());
    }
    return "";
}

} // namespace

MeshFigures run_mesh_trial(const MeshTrial& trial)
{
    Random random = Random::seeded(trial.seed);
    RandomMeshMotion motion(trial.tool, trial.object, trial.tree, trial.scale, random);
    return MeshRun(trial, motion).run();
}

MeshFigures run_mesh_slide(const MeshTrial& trial)
{
    Random random = Random::seeded(trial.seed);
    MeshSlide motion(trial.tool, trial.object, trial.tree, trial.scale, random);
    return MeshRun(trial, motion).run();
}

MeshFigures run_coincident_meshes(const MeshTrial& trial)
{
    CoincidentMotion motion(trial.tool, trial.object);
    return MeshRun(trial, motion).run();
}

TrialFigures run_mesh_twin(const MeshTrial& trial)
{
    Random random = Random::seeded(trial.seed);
    RandomMeshMotion motion(trial.tool, trial.object, trial.tree, trial.scale, random);
    const std::unique_ptr<FrameRig> whole = whole_models(trial);
    FrameRig rig({&trial.object, &trial.tool}, rig_options(trial));
    TrialFigures figures{name_of(trial) + ", identical", 0, 0.0, 0.0, "frames", 0, {}};
    for (std::uint32_t frame = 0; frame < trial.frames; ++frame)
    {
        const MeshMoment moment = motion.next();
        const PairOutput ours = step(rig, moment, trial.hardship.budgets).pairs[0];
        const PairOutput full = step(*whole, moment, trial.hardship.budgets).pairs[0];
        if (ours.kind != AnswerKind::exact || full.kind != AnswerKind::exact)
        {
            continue;
        }
        ++figures.trials;
        if (const std::string text = difference(ours, full); !text.empty())
        {
            figures.flag(where(trial, frame, motion.activity()) + text);
            figures.observe(static_cast<double>(figures.violations));
        }
    }
    return figures;
}

PairlessFigures run_mesh_without_pairs(const MeshTrial& trial)
{
    Random random = Random::seeded(trial.seed);
    RandomMeshMotion motion(trial.tool, trial.object, trial.tree, trial.scale, random);
    const auto with = rig_without_contacts(trial, true);
    const auto without = rig_without_contacts(trial, false);
    PairlessFigures figures{{name_of(trial) + ", without pairs", 0, 0.0, 0.0, "frames", 0, {}}};
    for (std::uint32_t frame = 0; frame < trial.frames; ++frame)
    {
        const MeshMoment moment = motion.next();
        const PairOutput all = step(*with, moment, trial.hardship.budgets).pairs[0];
        const PairOutput first = step(*without, moment, trial.hardship.budgets).pairs[0];
        ++figures.same.trials;
        figures.met += all.mesh->meeting.size() > 1 ? 1U : 0U;
        if (const std::string text = difference_without_pairs(all, first); !text.empty())
        {
            figures.same.flag(where(trial, frame, motion.activity()) + text);
            figures.same.observe(static_cast<double>(figures.same.violations));
        }
    }
    return figures;
}

} // namespace tactus::test
