// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/inside_test.hpp"

#include <cmath>
#include <numbers>

namespace tactus
{

InsideTest::InsideTest(const ModelHeader& header, std::span<const std::byte> base)
    : margin_m_(static_cast<double>(header.quantum_m()) * header.fields().max_error_quanta)
{
    const ModelCounts counts = header.counts();
    std::vector<Vec3f> positions_m(counts.base_vertices);
    std::vector<BaseFace> faces(counts.base_faces);
    std::vector<std::uint32_t> next(counts.base_faces);
    if (!header.is_closed() || !parse_base_mesh(base, header, {positions_m, faces, next}))
    {
        return;
    }
    for (const BaseFace& face : faces)
    {
        const auto corner = [&](std::size_t i)
        { return to_vec3(positions_m[face.corners[i].value]); };
        faces_m_.push_back({corner(0), corner(1), corner(2)});
    }
}

bool InsideTest::holds(const Vec3& place_m) const
{
    if (faces_m_.empty() || !is_wound_round(place_m))
    {
        return false;
    }
    for (int axis = 0; axis < 3; ++axis)
    {
        const Vec3 step_m = margin_m_ * Vec3::Unit(axis);
        if (!is_wound_round(place_m + step_m) || !is_wound_round(place_m - step_m))
        {
            return false;
        }
    }
    return true;
}

/// Winding number test: the sum of the solid angles of all faces (Van Oosterom and Strackee 1983)
/// is zero outside. Inside it is 4 pi, or -4 pi for faces of the opposite orientation.
bool InsideTest::is_wound_round(const Vec3& place_m) const
{
    double half_angles = 0.0;
    for (const auto& face : faces_m_)
    {
        const Vec3 a = face[0] - place_m;
        const Vec3 b = face[1] - place_m;
        const Vec3 c = face[2] - place_m;
        const double la = a.norm();
        const double lb = b.norm();
        const double lc = c.norm();
        half_angles += std::atan2(a.dot(b.cross(c)),
                                  la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
    // Half of 2 pi, which is the sum of the half angles inside.
    return std::abs(half_angles) > std::numbers::pi;
}

} // namespace tactus
