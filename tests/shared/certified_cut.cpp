// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/certified_cut.hpp"

#include "tests/shared/face_tree.hpp"
#include "tests/shared/test_model.hpp"

#include <algorithm>
#include <limits>

namespace tactus::test
{

namespace
{

/// FaceTree::least_excess() by another formula, in extended precision, face by face.
double judged_excess(const CertifiedCut& cut, const Vec3& point_m)
{
    long double least = std::numeric_limits<long double>::infinity();
    for (std::size_t i = 0; i < cut.faces.size(); ++i)
    {
        least = std::min(least, brute_distance(point_m, cut.faces[i]) -
                                    static_cast<long double>(cut.bounds_m[i]));
    }
    return static_cast<double>(least);
}

} // namespace

CertifiedCut cut_of(const PreparedMesh& prepared, const ForestReplay& replay)
{
    PreparedMesh part;
    part.quantum_m = prepared.quantum_m;
    part.mesh.positions = prepared.mesh.positions;
    part.mesh.faces = replay.active_corners();
    CertifiedCut cut;
    cut.faces = faces_on_grid(part);
    for (const ForestReplay::Face& face : replay.faces())
    {
        if (face.active)
        {
            cut.bounds_m.push_back(static_cast<double>(face.error) * prepared.quantum_m);
        }
    }
    return cut;
}

CertifiedCut cut_on_the_way(const PreparedMesh& prepared, const Simplification& simplification,
                            std::size_t faces)
{
    ForestReplay replay(simplification, prepared.mesh.faces.size());
    std::size_t count = simplification.base_faces.size();
    for (auto i = static_cast<std::uint32_t>(simplification.collapses.size()); i-- > 0;)
    {
        const auto& star = simplification.collapses[i].star;
        count += static_cast<std::size_t>(std::count_if(star.begin(), star.begin() + 2,
                                                        [](std::uint32_t face)
                                                        { return face != Collapse::kNoFace; }));
        if (count > faces)
        {
            break;
        }
        replay.split_with_closure(i);
    }
    return cut_of(prepared, replay);
}

CertifiedCut cut_of(const DecodedModel& model, const Replay& replay)
{
    CertifiedCut cut;
    const double quantum_m = static_cast<double>(model.header().quantum_m());
    for (std::uint32_t i = 0; i < model.header().counts().face_ids(); ++i)
    {
        if (!replay.is_active({i}))
        {
            continue;
        }
        Face& face = cut.faces.emplace_back();
        for (std::size_t corner = 0; corner < 3; ++corner)
        {
            face[corner] = model.position_m(replay.corners({i})[corner]);
        }
        const ErrorCode code = model.error_of({i}, replay.state({i}));
        cut.bounds_m.push_back(static_cast<double>(error_in_quanta(code)) * quantum_m);
    }
    return cut;
}

CertifiedCut with_bounds_times(double factor, CertifiedCut cut)
{
    for (double& bound_m : cut.bounds_m)
    {
        bound_m *= factor;
    }
    return cut;
}

std::optional<Violation> find_violation(const CertifiedCut& cut, std::span<const Vec3> points_m,
                                        double tolerance_m)
{
    const FaceTree tree(cut.faces, cut.bounds_m);
    for (const Vec3& point_m : points_m)
    {
        if (tree.least_excess(point_m, tolerance_m) > tolerance_m)
        {
            if (const double excess_m = judged_excess(cut, point_m); excess_m > tolerance_m)
            {
                return Violation{point_m, excess_m};
            }
        }
    }
    return std::nullopt;
}

} // namespace tactus::test
