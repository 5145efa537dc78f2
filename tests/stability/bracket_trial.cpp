// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/stability/bracket_trial.hpp"

#include "tests/shared/face_tree.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/frame_verdict.hpp"
#include "tests/stability/random_motion.hpp"
#include "tests/stability/tool_oracle.hpp"
#include "tests/stability/trial_terms.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace tactus::test
{

namespace
{

constexpr std::array<double, 3> kScales{1.0, 0.2, 3.0};

/// Frames of one trial and their evaluation.
class BracketRun
{
public:
    explicit BracketRun(const BracketTrial& trial)
        : trial_(trial)
        , random_(Random::seeded(trial.seed))
        , scale_(kScales[random_.below(kScales.size())])
        , radius_m_(trial.hardship.radius_diag * trial.model.diagonal_m)
        , motion_(trial.model, trial.tree, radius_m_, scale_, random_)
        , rig_(trial.model, with_seed(with_tool(trial.hardship.rig, scale_ * radius_m_)))
    {
        figures_.bounded.name = trial.model.name + ", " + trial.hardship.name;
        figures_.bounded.unit = "of the bounds";
    }

    [[nodiscard]] BracketFigures run()
    {
        for (frame_ = 0; frame_ < trial_.frames; ++frame_)
        {
            const Moment moment = motion_.next();
            rig_.place_object(moment.pose);
            check(rig_.step(moment.goal_m, trial_.hardship.budgets), moment.pose);
        }
        return figures_;
    }

private:
    [[nodiscard]] RigOptions with_seed(RigOptions options) const
    {
        options.faults.seed = trial_.seed + 1;
        return options;
    }

    void check(const FrameOutput& output, const ObjectPose& pose)
    {
        const PairOutput& pair = output.pairs[0];
        ++figures_.bounded.trials;
        figures_.seen |= output.faults;
        const bool is_exact = pair.kind == AnswerKind::exact;
        figures_.exact += is_exact ? 1 : 0;
        figures_.answered += is_exact || pair.kind == AnswerKind::separated ? 1 : 0;
        // A point in its first frame has no reach, so it requests nothing.
        const bool reaches_nothing = frame_ == 0 && radius_m_ == 0.0;
        for (const Verdict& verdict : {broken_budget(output, trial_.hardship.budgets),
                                       reaches_nothing ? std::nullopt : unexplained(output)})
        {
            if (verdict)
            {
                flag(*verdict);
            }
        }
        const BracketVerdict verdict = judge_bracket(trial_.oracle, pair, pose);
        if (is_exact || verdict.error > 1.0)
        {
            figures_.bounded.observe(verdict.error);
        }
        if (verdict.error > 1.0)
        {
            flag(verdict.text);
        }
        if (frame_ % kCheckedFrames == 0)
        {
            check_oracle(wide_place(pose, pair.point_m));
        }
    }

    void check_oracle(const WidePoint& place)
    {
        if (trial_.oracle.nearest(place).distance_m != trial_.oracle.brute(place))
        {
            flag("the oracle's tree and brute force differ");
        }
    }

    void flag(const std::string& what)
    {
        figures_.bounded.flag(figures_.bounded.name +
                              ", TACTUS_SEED=" + std::to_string(trial_.seed) + ", frame " +
                              std::to_string(frame_) + " (" + motion_.activity() + "): " + what);
    }

    const BracketTrial& trial_;
    Random random_;
    double scale_;
    double radius_m_;
    RandomMotion motion_;
    FrameRig rig_;
    BracketFigures figures_;
    std::uint32_t frame_{0};
};

std::vector<Face> base_faces(FrameRig& rig)
{
    const VertexForest& forest = rig.model().forest;
    std::vector<Face> faces;
    for (std::uint32_t i = 0; i < forest.active_faces(); ++i)
    {
        faces.push_back(forest.corners_of(PrimId{i}));
    }
    return faces;
}

struct WorstPoint
{
    double distance_m{-1.0};
    Vec3 point_m{0.0, 0.0, 0.0};
};

/// One place for each face that some vertex is nearest to.
std::vector<WorstPoint> worst_points(const std::vector<Face>& base, const TestModel& model)
{
    const FaceTree tree(base);
    std::vector<WorstPoint> worst(base.size());
    for (const Face& face : model.faces)
    {
        for (const Vec3f& corner : face)
        {
            const FaceTree::Nearest nearest = tree.nearest(to_vec3(corner));
            if (nearest.distance_m > worst[nearest.face].distance_m)
            {
                worst[nearest.face] = {nearest.distance_m, to_vec3(corner)};
            }
        }
    }
    std::erase_if(worst, [](const WorstPoint& point) { return point.distance_m <= 0.0; });
    return worst;
}

} // namespace

BracketFigures run_bracket_trial(const BracketTrial& trial)
{
    return BracketRun(trial).run();
}

BracketVerdict judge_bracket(const ToolOracle& oracle, const PairOutput& pair,
                             const ObjectPose& pose)
{
    const WidePoint place = wide_place(pose, pair.point_m);
    const auto scale = static_cast<long double>(pose.scale);
    const FaceTree::WideNearest nearest = oracle.nearest(place);
    long double distance = scale * nearest.distance_m;
    BracketVerdict verdict;
    if (!is_between(pair.lower_m, distance, pair.upper_m))
    {
        // 113 bits decide if long double is not certain.
        const double doubt = 1e-12 * (pair.point_m.norm() + pair.upper_m);
        const bool is_clear = !is_between(pair.lower_m - doubt, distance, pair.upper_m + doubt);
        const Quad judged = is_clear ? static_cast<Quad>(distance)
                                     : static_cast<Quad>(scale) * oracle.judged(place);
        distance = static_cast<long double>(judged);
        if (!is_between(pair.lower_m, judged, pair.upper_m))
        {
            verdict.text = "face " + std::to_string(nearest.face) + " of the source is " +
                           exactly(static_cast<double>(distance)) + " from " +
                           exactly(pair.point_m) + ", not " + exactly(pair.lower_m) + " .. " +
                           exactly(pair.upper_m) + "; object at " + exactly(pose.translation_m) +
                           ", scale " + exactly(pose.scale);
            verdict.error = std::numeric_limits<double>::infinity();
        }
    }
    const long double half =
        (static_cast<long double>(pair.upper_m) - static_cast<long double>(pair.lower_m)) / 2;
    const long double off = std::abs(distance - static_cast<long double>(pair.lower_m) - half);
    if (off > 0)
    {
        verdict.error = std::max(verdict.error, static_cast<double>(off / half));
    }
    return verdict;
}

TrialFigures query_worst_points(const TestModel& model)
{
    FrameRig rig(model, {});
    const CenterOracle oracle(model);
    Budgets no_splits;
    no_splits.splits = 0;
    TrialFigures figures;
    figures.name = model.name + ", worst points of the base mesh";
    for (const WorstPoint& worst : worst_points(base_faces(rig), model))
    {
        // The hand stays exactly at the origin, and the object is moved to it.
        ObjectPose pose;
        pose.translation_m = -worst.point_m;
        rig.place_object(pose);
        const PairOutput pair = rig.step(Vec3(0.0, 0.0, 0.0), no_splits).pairs[0];
        const BracketVerdict verdict = judge_bracket(oracle, pair, pose);
        ++figures.trials;
        if (!verdict.text.empty())
        {
            figures.flag(figures.name + ": " + verdict.text);
        }
    }
    return figures;
}

} // namespace tactus::test
