// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/peers/all_peers.hpp"
#include "tests/shared/closest_point.hpp"

#include <atomic>
#include <cmath>
#include <cstddef>
#include <embree3/rtcore.h>
#include <limits>
#include <stdexcept>

namespace tactus::bench
{

namespace
{

class EmbreeQuery final : public TouchQuery
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
    [[nodiscard]] Vec3 nearest_m() const override { return nearest_m_; }
    [[nodiscard]] std::optional<std::size_t> own_bytes() const override
    {
        return static_cast<std::size_t>(bytes_.load());
    }

private:
    static bool count_bytes(void* bytes, ssize_t change, bool post);
    static bool visit(RTCPointQueryFunctionArguments* arguments);
    void check(const char* step) const;

    const std::vector<test::Face>& faces_;
    std::atomic<std::ptrdiff_t> bytes_{0}; ///< Bytes of the device: buffers and trees.
    Vec3 nearest_m_{0.0, 0.0, 0.0};
    RTCDevice device_;
    RTCScene scene_;
};

/// State of one query, passed as the callback's user pointer.
struct Search
{
    const test::Face* faces{nullptr};
    bool found{false};
    test::Point<float> nearest{};
};

EmbreeQuery::EmbreeQuery(const std::vector<test::Face>& faces)
    : faces_(faces), device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_))
{
    rtcSetDeviceMemoryMonitorFunction(device_, count_bytes, &bytes_);
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

bool EmbreeQuery::count_bytes(void* bytes, ssize_t change, bool /*post*/)
{
    *static_cast<std::atomic<std::ptrdiff_t>*>(bytes) += change;
    return true;
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
    const test::Point<float> nearest = test::closest_on_triangle(point, face[0], face[1], face[2]);
    const test::Point<float> gap = test::difference(point, nearest);
    const float distance = std::sqrt(test::dot(gap, gap));
    if (!(distance < query.radius))
    {
        return false;
    }
    query.radius = distance;
    search.found = true;
    search.nearest = nearest;
    return true;
}

double EmbreeQuery::distance_m(const Vec3& point_m, double band_m)
{
    RTCPointQuery query{};
    query.x = static_cast<float>(point_m.x());
    query.y = static_cast<float>(point_m.y());
    query.z = static_cast<float>(point_m.z());
    query.radius = static_cast<float>(band_m);
    Search search{faces_.data(), false, {}};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_, &query, &context, visit, &search);
    if (!search.found)
    {
        return std::numeric_limits<double>::infinity();
    }
    nearest_m_ = to_vec3(search.nearest);
    return static_cast<double>(query.radius);
}

} // namespace

std::unique_ptr<TouchQuery> make_embree_query(const std::vector<test::Face>& faces,
                                              double /*radius_m*/)
{
    return std::make_unique<EmbreeQuery>(faces);
}

} // namespace tactus::bench
