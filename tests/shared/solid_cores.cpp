// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/solid_cores.hpp"

#include "tests/shared/exact_meet.hpp"

#include <Eigen/Geometry>

#include <algorithm>

namespace tactus::test
{

SolidCore box_core(const std::string& name, const Vec3& half, double radius_m)
{
    SolidCore solid{name, Box{half}, {}, radius_m};
    for (Eigen::Index axis = 0; axis < 3; ++axis)
    {
        for (const double side : {-1.0, 1.0})
        {
            const auto corner = [&](double u, double v)
            {
                Vec3 at;
                at[axis] = side;
                at[(axis + 1) % 3] = u;
                at[(axis + 2) % 3] = v;
                return Vec3(at.cwiseProduct(half));
            };
            solid.faces.push_back({corner(-1, -1), corner(1, -1), corner(1, 1)});
            solid.faces.push_back({corner(-1, -1), corner(1, 1), corner(-1, 1)});
        }
    }
    return solid;
}

SolidCore segment_core(const std::string& name, const Segment& segment, double radius_m)
{
    return {name, segment, {{segment.from, segment.to, segment.to}}, radius_m};
}

SolidCore spike_core(double radius_m)
{
    static const std::array<Vec3, 4> s{Vec3(0, 0, -0.02), Vec3(0.006, 0, 0.01),
                                       Vec3(-0.004, 0.005, 0.01), Vec3(-0.004, -0.005, 0.01)};
    return {"spike",
            Hull::create(s).value(),
            {{s[0], s[1], s[2]}, {s[0], s[2], s[3]}, {s[0], s[3], s[1]}, {s[1], s[2], s[3]}},
            radius_m};
}

SolidCore mesh_core(const std::string& name, const TestModel& mesh, double radius_m)
{
    SolidCore solid{name, MeshCore{ModelId{1}}, {}, radius_m, &mesh};
    const Vec3 origin(mesh.origin_m[0], mesh.origin_m[1], mesh.origin_m[2]);
    for (const Face& face : mesh.faces)
    {
        solid.faces.push_back(
            {origin + to_vec3(face[0]), origin + to_vec3(face[1]), origin + to_vec3(face[2])});
    }
    return solid;
}

int crossings(const SolidCore& solid, const Similarity& place, const TestModel& model)
{
    std::vector<Triangle> placed = solid.faces;
    std::vector<Vec3> lows;
    std::vector<Vec3> highs;
    Vec3 low(1e9, 1e9, 1e9);
    Vec3 high = -low;
    for (Triangle& face : placed)
    {
        for (Vec3& corner : face)
        {
            corner = place.local_to_world(corner);
        }
        lows.push_back(least_of(least_of(face[0], face[1]), face[2]));
        highs.push_back(greatest_of(greatest_of(face[0], face[1]), face[2]));
        low = least_of(low, lows.back());
        high = greatest_of(high, highs.back());
    }
    int met = 0;
    for (const Face& face : model.faces)
    {
        const Triangle other = to_triangle(face);
        const Vec3 least = least_of(least_of(other[0], other[1]), other[2]);
        const Vec3 most = greatest_of(greatest_of(other[0], other[1]), other[2]);
        const auto is_off = [&](const Vec3& from, const Vec3& to)
        { return (most.array() < from.array()).any() || (least.array() > to.array()).any(); };
        for (std::size_t i = 0; i < placed.size() && !is_off(low, high); ++i)
        {
            met += !is_off(lows[i], highs[i]) && exactly_meet(placed[i], other) ? 1 : 0;
        }
    }
    return met;
}

int crossings_on_way(const SolidCore& solid, const Similarity& from, const Similarity& to,
                     const Vec3& center, const TestModel& model, int places)
{
    const Vec3 way = to.local_to_world(center) - from.local_to_world(center);
    const Eigen::AngleAxisd turned(to.rotation * from.rotation.transpose());
    int met = 0;
    for (int i = 1; i <= places; ++i)
    {
        const double share = static_cast<double>(i) / places;
        Similarity place = to;
        if (i < places)
        {
            place.rotation =
                Eigen::AngleAxisd(share * turned.angle(), turned.axis()).toRotationMatrix() *
                from.rotation;
            place.translation_m =
                from.local_to_world(center) + share * way - place.scale * (place.rotation * center);
        }
        met += crossings(solid, place, model);
    }
    return met;
}

} // namespace tactus::test
