// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_input.hpp"
#include "tests/shared/distance_oracle.hpp"
#include "tests/shared/face_tree.hpp"
#include "tests/shared/test_model.hpp"

#include <cstdint>

namespace tactus::test
{

using WidePoint = Point<long double>;

/// True distance between a tool at a place of the model frame and the whole source mesh. A frame's
/// bounds depend on the tool's shape, so another shape needs only another oracle.
class ToolOracle
{
public:
    ToolOracle() = default;
    ToolOracle(const ToolOracle&) = delete;
    ToolOracle& operator=(const ToolOracle&) = delete;
    ToolOracle(ToolOracle&&) = delete;
    ToolOracle& operator=(ToolOracle&&) = delete;
    virtual ~ToolOracle() = default;

    /// Nearest point, fast, in long double.
    [[nodiscard]] virtual FaceTree::WideNearest nearest(const WidePoint& place_m) const = 0;
    /// Distance face by face in long double, to check `nearest`.
    [[nodiscard]] virtual long double brute(const WidePoint& place_m) const = 0;
    /// Distance face by face in 113 bits, to decide if `nearest` and the bounds differ.
    [[nodiscard]] virtual Quad judged(const WidePoint& place_m) const = 0;
};

/// Oracle of points and spheres, whose distance is that of the centre.
class CenterOracle final : public ToolOracle
{
public:
    explicit CenterOracle(const TestModel& model) : faces_(model.faces), tree_(model.faces) {}

    [[nodiscard]] const FaceTree& tree() const { return tree_; }
    [[nodiscard]] FaceTree::WideNearest nearest(const WidePoint& place_m) const override
    {
        return tree_.wide_nearest(place_m);
    }
    [[nodiscard]] long double brute(const WidePoint& place_m) const override
    {
        return least_over_faces<long double>(place_m);
    }
    [[nodiscard]] Quad judged(const WidePoint& place_m) const override
    {
        return least_over_faces<Quad>({static_cast<Quad>(place_m[0]), static_cast<Quad>(place_m[1]),
                                       static_cast<Quad>(place_m[2])});
    }

private:
    template <typename Real>
    [[nodiscard]] Real least_over_faces(const Point<Real>& place_m) const
    {
        Real least = BasicDistanceOracle<Real>::kInfinity;
        for (const Face& face : faces_)
        {
            const Real distance = wide_distance(place_m, face);
            least = distance < least ? distance : least;
        }
        return least;
    }

    const std::vector<Face>& faces_;
    FaceTree tree_;
};

/// Place of the world in the model frame, without significant rounding, by the inverse of the
/// rotation, which its transpose only approximates.
[[nodiscard]] inline WidePoint wide_place(const ObjectPose& pose, const Vec3& world_m)
{
    using WideMatrix = Eigen::Matrix<long double, 3, 3>;
    using WideVector = Eigen::Matrix<long double, 3, 1>;
    const WideMatrix rotation = pose.rotation.cast<long double>();
    const WideVector relative =
        world_m.cast<long double>() - pose.translation_m.cast<long double>();
    const WideVector place = rotation.inverse() * relative / static_cast<long double>(pose.scale);
    return {place.x(), place.y(), place.z()};
}

} // namespace tactus::test
