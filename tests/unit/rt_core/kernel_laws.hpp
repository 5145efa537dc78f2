// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/distance_oracle.hpp"
#include "tests/unit/rt_core/kernel_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

namespace tactus::test
{

/// Truth for bounds: a face and a probe in extended precision, in quanta.
struct FaceTruth
{
    long double distance{0.0L};
    long double corner{0.0L}; ///< Distance to the nearest corner.
    long double local{0.0L};  ///< Greatest of edges and distances to the corners.
    long double longest{0.0L};
    /// Longest edge squared divided by twice the area; huge without an area.
    long double aspect{0.0L};

    FaceTruth(const KernelScene& scene, std::uint32_t lane)
    {
        const Triangle face = to_triangle(block_triangle(scene.block, lane));
        const auto quantum = static_cast<long double>(scene.quantum_m);
        distance = DistanceOracle::distance(scene.point_m, face) / quantum;
        corner = 1e30L;
        for (std::size_t i = 0; i < 3; ++i)
        {
            const long double edge = length(face[i], face[(i + 1) % 3]) / quantum;
            const long double reach = length(scene.point_m, face[i]) / quantum;
            longest = std::max(longest, edge);
            corner = std::min(corner, reach);
            local = std::max({local, edge, reach});
        }
        const long double area_twice = twice_area(face) / (quantum * quantum);
        aspect = area_twice > 0.0L ? longest * longest / area_twice : 1e30L;
    }

    /// True if the face may count as thin, within rounding of the limit.
    [[nodiscard]] bool may_be_thin() const { return aspect > 0.999L * kThinAspectLimit; }

    static constexpr long double kThinAspectLimit = static_cast<long double>(kThinAspect);

private:
    static long double coordinate(const Vec3& a, const Vec3& b, int axis)
    {
        return static_cast<long double>(b[axis]) - static_cast<long double>(a[axis]);
    }
    static long double length(const Vec3& a, const Vec3& b)
    {
        const long double x = coordinate(a, b, 0);
        const long double y = coordinate(a, b, 1);
        const long double z = coordinate(a, b, 2);
        return std::sqrt(x * x + y * y + z * z);
    }
    static long double twice_area(const Triangle& face)
    {
        long double sum = 0.0L;
        for (int axis = 0; axis < 3; ++axis)
        {
            const int y = (axis + 1) % 3;
            const int z = (axis + 2) % 3;
            const long double part =
                coordinate(face[0], face[1], y) * coordinate(face[0], face[2], z) -
                coordinate(face[0], face[1], z) * coordinate(face[0], face[2], y);
            sum += part * part;
        }
        return std::sqrt(sum);
    }
};

/// Bounds of one face by a kernel set, in quanta.
struct LaneAnswer
{
    float lower{0.0F};
    float upper{0.0F};
    float corner{0.0F};
};

/// Asks for one face alone: its upper bound is then the new limit. The corner's bound applies only
/// to a coarse face.
[[nodiscard]] inline LaneAnswer ask_lane(const Kernels& kernels, const KernelScene& scene,
                                         std::uint32_t lane)
{
    FaceBounds bounds;
    float limit = std::numeric_limits<float>::infinity();
    kernels.face_bounds(scene.coordinates(), scene.corners(), scene.probe, 1U << lane, 1U << lane,
                        0.0F, limit, bounds);
    const float lower = bounds.lower[lane];
    float unchanged = limit;
    kernels.face_bounds(scene.coordinates(), scene.corners(), scene.probe, 1U << lane, 0, 0.0F,
                        unchanged, bounds);
    return {lower, limit, bounds.corner[lane]};
}

/// Violation of kernels.hpp's law, if any: bounds are on their side of the truth and within the
/// stated distance.
[[nodiscard]] inline std::string law_fault(const LaneAnswer& answer, const FaceTruth& truth,
                                           const KernelProbe& probe)
{
    const long double slack = 2.0L * static_cast<long double>(probe.slack);
    const long double margin = 2.0L * static_cast<long double>(kFaceMargin) * truth.local + slack;
    const long double thin =
        truth.may_be_thin() ? truth.longest / FaceTruth::kThinAspectLimit : 0.0L;
    const auto lower = static_cast<long double>(answer.lower);
    const auto upper = static_cast<long double>(answer.upper);
    const auto corner = static_cast<long double>(answer.corner);
    std::ostringstream text;
    const auto check = [&](bool holds, const char* what, long double bound)
    {
        if (!holds) // Includes NaN.
        {
            text << what << " " << bound << "; distance " << truth.distance << ", corner "
                 << truth.corner << ", local length " << truth.local << ", aspect " << truth.aspect
                 << "\n";
        }
    };
    check(lower <= truth.distance, "lower bound above the distance:", lower);
    check(lower >= truth.distance - margin - thin, "lower bound too loose:", lower);
    check(upper >= truth.distance, "upper bound below the distance:", upper);
    check(upper <= truth.distance + margin + thin, "upper bound too loose:", upper);
    check(corner >= truth.corner, "corner bound below the nearest corner:", corner);
    check(corner <= truth.corner + margin, "corner bound too loose:", corner);
    return text.str();
}

} // namespace tactus::test
