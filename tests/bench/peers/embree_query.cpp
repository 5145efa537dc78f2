// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/peers/embree_query.hpp"

#include "tests/shared/closest_point.hpp"

#include <cmath>
#include <embree3/rtcore.h>
#include <limits>
#include <stdexcept>

namespace tactus::bench
{

namespace
{

class EmbreeQuery final : public PointQuery
{
public:
    explicit EmbreeQuery(const std::vector<test::Face>& faces);
    EmbreeQuery(const EmbreeQuery&) = delete;
    EmbreeQuery& operator=(const EmbreeQuery&) = delete;
    ~EmbreeQuery() override
    {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }

    [[nodiscard]] std::string name() const override { return "Embree"; }
    [[nodiscard]] double distance_m(const Vec3& point_m, double band_m) override;

private:
    static bool visit(RTCPointQueryFunctionArguments* arguments);
    void check(const char* step) const;

    const std::vector<test::Face>& faces_;
    RTCDevice device_;
    RTCScene scene_;
};

/// What one query knows; the callback's user pointer.
struct Search
{
    const test::Face* faces{nullptr};
    bool found{false};
};

EmbreeQuery::EmbreeQuery(const std::vector<test::Face>& faces)
    : faces_(faces), device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_))
{
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* corners = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), 3 * faces.size()));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), faces.size()));
    check("buffers");
    for (std::size_t i = 0; i < 3 * faces.size(); ++i)
    {
        corners[i] = faces[i / 3][i % 3];
        indices[i] = static_cast<unsigned>(i);
    }
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    rtcCommitScene(scene_);
    check("build");
}

void EmbreeQuery::check(const char* step) const
{
    if (const RTCError error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
    {
        throw std::runtime_error(std::string("Embree: ") + step + ": error " +
                                 std::to_string(static_cast<int>(error)));
    }
}

bool EmbreeQuery::visit(RTCPointQueryFunctionArguments* arguments)
{
    Search& search = *static_cast<Search*>(arguments->userPtr);
    RTCPointQuery& query = *arguments->query;
    const test::Face& face = search.faces[arguments->primID];
    const test::Point<float> point{query.x, query.y, query.z};
    const test::Point<float> gap =
        test::difference(point, test::closest_on_triangle(point, face[0], face[1], face[2]));
    const float distance = std::sqrt(test::dot(gap, gap));
    if (!(distance < query.radius))
    {
        return false;
    }
    query.radius = distance;
    search.found = true;
    return true;
}

double EmbreeQuery::distance_m(const Vec3& point_m, double band_m)
{
    RTCPointQuery query{};
    query.x = static_cast<float>(point_m.x());
    query.y = static_cast<float>(point_m.y());
    query.z = static_cast<float>(point_m.z());
    query.radius = static_cast<float>(band_m);
    Search search{faces_.data(), false};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_, &query, &context, visit, &search);
    return search.found ? static_cast<double>(query.radius)
                        : std::numeric_limits<double>::infinity();
}

} // namespace

std::unique_ptr<PointQuery> make_embree_query(const std::vector<test::Face>& faces)
{
    return std::make_unique<EmbreeQuery>(faces);
}

} // namespace tactus::bench
