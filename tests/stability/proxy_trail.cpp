// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/stability/proxy_trail.hpp"

#include "tests/shared/exact_meet.hpp"
#include "tests/stability/tool_oracle.hpp"

#include <array>
#include <cstdio>

namespace tactus::test
{

namespace
{

Vec3 place_of(const ObjectPose& pose, const Vec3& world_m)
{
    const WidePoint place = wide_place(pose, world_m);
    return {static_cast<double>(place[0]), static_cast<double>(place[1]),
            static_cast<double>(place[2])};
}

} // namespace

std::string Crossing::text() const
{
    std::array<char, 256> text{};
    std::snprintf(text.data(), text.size(), "(%.17g, %.17g, %.17g) to (%.17g, %.17g, %.17g)",
                  from_m.x(), from_m.y(), from_m.z(), to_m.x(), to_m.y(), to_m.z());
    return "face " + std::to_string(face) + " met from " + text.data();
}

std::optional<Crossing> find_crossing(const TestModel& model, const FaceTree& tree,
                                      const Vec3& from_m, const Vec3& to_m)
{
    for (const std::uint32_t face :
         tree.faces_near_box(from_m.cwiseMin(to_m), from_m.cwiseMax(to_m)))
    {
        const Face& corners = model.faces[face];
        const Triangle triangle{to_vec3(corners[0]), to_vec3(corners[1]), to_vec3(corners[2])};
        if (exactly_meet(from_m, to_m, triangle))
        {
            return Crossing{from_m, to_m, face};
        }
    }
    return std::nullopt;
}

ProxyTrail::Crossings ProxyTrail::follow(std::span<const Vec3> path_m, const ObjectPose& pose)
{
    Crossings crossings;
    bool is_carried = true;
    for (const Vec3& place : path_m)
    {
        const Vec3 next = place_of(pose, place);
        if (last_m_ && *last_m_ != next)
        {
            std::optional<Crossing>& found = is_carried ? crossings.carried : crossings.moved;
            found = found ? found : find_crossing(*model_, *tree_, *last_m_, next);
        }
        last_m_ = next;
        is_carried = false;
    }
    return crossings;
}

} // namespace tactus::test
