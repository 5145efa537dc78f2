// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/report/report.hpp"
#include "rt_core/spm/base_mesh.hpp"
#include "transport/base/number_form.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace tactus::hrtc
{

namespace
{

/// Largest number of faces; more enlarge the page without a better picture.
constexpr std::size_t kFacesMax = 8'000;

plot::Place to_place(const Vec3& place_m)
{
    return {static_cast<float>(place_m.x()), static_cast<float>(place_m.y()),
            static_cast<float>(place_m.z())};
}

/// Base faces of an object in the world; empty if the base mesh isn't resident.
std::vector<std::array<plot::Place, 3>> faces_of(const Controller& controller, std::size_t object)
{
    const ServedModel& model = controller.models()[controller.objects()[object].model.value];
    const ModelHeader header = ModelHeader::parse(model.header).value();
    const ObjectPose pose = model_pose(controller.poses()[object], header.origin_m());
    const ModelCounts counts = header.counts();
    std::vector<Vec3f> positions_m(counts.base_vertices);
    std::vector<BaseFace> base(counts.base_faces);
    std::vector<std::uint32_t> next(counts.base_faces);
    std::vector<std::array<plot::Place, 3>> faces;
    if (!parse_base_mesh(model.base, header, {positions_m, base, next}))
    {
        return faces;
    }
    for (const BaseFace& face : base)
    {
        const auto corner = [&](std::size_t i)
        { return to_place(to_world(pose, to_vec3(positions_m[face.corners[i].value]))); };
        faces.push_back({corner(0), corner(1), corner(2)});
    }
    return faces;
}

/// Numbers of the objects, in the order of their origins' distance to the middle of the paths.
std::vector<std::size_t> nearest_first(const Controller& controller,
                                       const std::vector<std::vector<plot::WayPoint>>& ways)
{
    Vec3 sum_m = Vec3::Zero();
    std::size_t count = 0;
    for (const std::vector<plot::WayPoint>& way : ways)
    {
        for (const plot::WayPoint& point : way)
        {
            sum_m += to_vec3(point.at);
            ++count;
        }
    }
    const Vec3 middle_m = sum_m / static_cast<double>(std::max<std::size_t>(count, 1));
    std::vector<std::size_t> order(controller.objects().size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(
        order, {},
        [&](std::size_t object)
        { return (controller.poses()[object].translation_m - middle_m).squaredNorm(); });
    return order;
}

} // namespace

plot::Relief relief_of(const Controller& controller, const RunStatistics& statistics)
{
    plot::Relief relief{.title = "Path of the tool and force on the device",
                        .faces = {},
                        .ways = {},
                        .unit = "N",
                        .note = {}};
    for (const ToolPath& path : statistics.paths)
    {
        std::vector<plot::WayPoint> way;
        for (const PathPoint& point : path.points())
        {
            way.push_back({point.place_m, point.force_n});
        }
        relief.ways.push_back(std::move(way));
    }
    std::size_t drawn = 0;
    for (const std::size_t object : nearest_first(controller, relief.ways))
    {
        const auto faces = faces_of(controller, object);
        if (relief.faces.size() + faces.size() > kFacesMax)
        {
            break;
        }
        relief.faces.insert(relief.faces.end(), faces.begin(), faces.end());
        drawn += faces.empty() ? 0U : 1U;
    }
    const std::size_t objects = controller.objects().size();
    relief.note = fmt::format("The picture shows the coarsest surface of {}{} at the start of the "
                              "run. At the tool the surface was finer.",
                              counted(drawn, "object"),
                              drawn < objects ? fmt::format(" of {}", objects) : "");
    return relief;
}

} // namespace tactus::hrtc
