// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/stability/worst_points.hpp"

#include "tests/shared/face_tree.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/stability/bracket_trial.hpp"

#include <algorithm>
#include <vector>

namespace tactus::test
{

namespace
{

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

/// One a face that some vertex is nearest to.
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
        // The hand stays at the origin, exactly, and the object is brought to it.
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
