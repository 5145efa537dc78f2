// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/certified_cut.hpp"

#include "tests/shared/face_tree.hpp"
#include "tests/shared/test_model.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace tactus::test
{

namespace
{

using Corners = std::array<std::uint32_t, 3>;
constexpr std::uint32_t kNoFace = Collapse::kNoFace;

/// Undoes collapses from the last one backwards, so that all that one depends on is undone before.
class BackwardReplay
{
public:
    BackwardReplay(const QuantisedMesh& mesh, const Simplification& simplification)
        : present_(mesh.faces.size()), count_(simplification.base_faces.size())
    {
        for (std::size_t i = 0; i < count_; ++i)
        {
            present_[simplification.base_faces[i]] = {
                true, simplification.base_corners[i],
                static_cast<double>(simplification.base_error[i])};
        }
    }

    [[nodiscard]] static std::size_t faces_added_by(const Collapse& collapse)
    {
        return (collapse.star[0] != kNoFace ? 1U : 0U) + (collapse.star[1] != kNoFace ? 1U : 0U);
    }
    [[nodiscard]] std::size_t face_count() const { return count_; }

    void undo(const Collapse& collapse)
    {
        Corners rim{};
        std::array<std::uint32_t, 2> ends{};
        for (std::uint32_t i = 0; i < collapse.fan_size; ++i)
        {
            State& face = present_[collapse.star[2 + i]];
            rim = face.corners;
            std::rotate(rim.begin(), std::find(rim.begin(), rim.end(), collapse.parent), rim.end());
            ends = {i == 0 ? rim[1] : ends[0], rim[2]};
            std::replace(face.corners.begin(), face.corners.end(), collapse.parent,
                         collapse.vertex);
            face.bound_quanta = static_cast<double>(collapse.error[2 + i]);
        }
        const std::array<Corners, 2> appearing{Corners{collapse.vertex, collapse.parent, ends[0]},
                                               Corners{collapse.vertex, ends[1], collapse.parent}};
        for (std::size_t side = 0; side < 2; ++side)
        {
            if (collapse.star[side] != kNoFace)
            {
                present_[collapse.star[side]] = {true, appearing[side],
                                                 static_cast<double>(collapse.error[side])};
            }
        }
        count_ += faces_added_by(collapse);
    }

    [[nodiscard]] CertifiedCut cut(const PreparedMesh& prepared) const
    {
        PreparedMesh part;
        part.quantum_m = prepared.quantum_m;
        part.mesh.positions = prepared.mesh.positions;
        CertifiedCut cut;
        for (const State& face : present_)
        {
            if (face.is_active)
            {
                part.mesh.faces.push_back(face.corners);
                cut.bounds_m.push_back(face.bound_quanta * prepared.quantum_m);
            }
        }
        cut.faces = faces_on_grid(part);
        return cut;
    }

private:
    struct State
    {
        bool is_active{false};
        Corners corners{};
        double bound_quanta{0.0};
    };

    std::vector<State> present_; ///< By face of the mesh.
    std::size_t count_;
};

/// The same as FaceTree::least_excess(), by another formula, in extended precision, face by face.
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

CertifiedCut cut_on_the_way(const PreparedMesh& prepared, const Simplification& simplification,
                            std::size_t faces)
{
    BackwardReplay replay(prepared.mesh, simplification);
    for (auto collapse = simplification.collapses.rbegin();
         collapse != simplification.collapses.rend() &&
         replay.face_count() + BackwardReplay::faces_added_by(*collapse) <= faces;
         ++collapse)
    {
        replay.undo(*collapse);
    }
    return replay.cut(prepared);
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
