// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/host_encode/mesh_oracles.hpp"

#include "tests/shared/distance_oracle.hpp"

#include <algorithm>
#include <limits>

namespace tactus
{
namespace
{

PlainFace turned(PlainFace face)
{
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    return face;
}

Point point_on(const PlainFace& face, double s, double t)
{
    Point p{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        p[axis] = (1.0 - s - t) * face[0][axis] + s * face[1][axis] + t * face[2][axis];
    }
    return p;
}

long double distance_to(const std::vector<PlainFace>& faces, const Point& point)
{
    long double least = std::numeric_limits<long double>::infinity();
    for (const PlainFace& face : faces)
    {
        least = std::min(least,
                         test::DistanceOracle::distance(
                             to_vec(point), {to_vec(face[0]), to_vec(face[1]), to_vec(face[2])}));
    }
    return least;
}

bool holds(const Zone& zone, const Point& point)
{
    const Vec3 p = to_vec(point);
    if (const auto* sphere = std::get_if<SphereZone>(&zone))
    {
        return (p - sphere->center_m).norm() <= sphere->radius_m;
    }
    const auto& box = std::get<BoxZone>(zone);
    return (p.array() >= box.low_m.array()).all() && (p.array() <= box.high_m.array()).all();
}

} // namespace

std::vector<PlainFace> faces_of(const TriangleMesh& mesh)
{
    std::vector<PlainFace> faces;
    for (const auto& [a, b, c] : mesh.faces)
    {
        faces.push_back(turned({mesh.positions[a], mesh.positions[b], mesh.positions[c]}));
    }
    return faces;
}

std::vector<PlainFace> source_faces(const EncodedModel& model)
{
    TriangleMesh mesh;
    mesh.faces = model.prepared.mesh.faces;
    for (const auto& position : model.prepared.mesh.positions)
    {
        Point& p = mesh.positions.emplace_back(model.prepared.origin_m);
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            p[axis] += position[axis] * model.prepared.quantum_m;
        }
    }
    return faces_of(mesh);
}

long double sampled_distance(const EncodedModel& model, const TriangleMesh& mesh, int samples,
                             test::Random& random)
{
    const std::vector<PlainFace> source = source_faces(model);
    const std::vector<PlainFace> faces = faces_of(mesh);
    long double largest = 0.0L;
    for (int i = 0; i < samples; ++i)
    {
        const PlainFace& face = source[random.below(static_cast<std::uint32_t>(source.size()))];
        const double s = random.between(0.0, 1.0);
        const Point point =
            random.one_in(2) ? face[0] : point_on(face, s, random.between(0.0, 1.0 - s));
        largest = std::max(largest, distance_to(faces, point));
    }
    return largest;
}

bool reaches_into(const Zone& zone, const PlainFace& face)
{
    constexpr int kSteps = 8;
    for (int i = 0; i <= kSteps; ++i)
    {
        for (int k = 0; k <= kSteps - i; ++k)
        {
            if (holds(zone, point_on(face, i / double{kSteps}, k / double{kSteps})))
            {
                return true;
            }
        }
    }
    return false;
}

} // namespace tactus
