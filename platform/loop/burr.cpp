// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/burr.hpp"

#include "rt_core/base/assert.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>
#include <utility>
#include <variant>

namespace tactus::hrtc
{

namespace
{

using Point2 = Eigen::Vector2d;

Vec3 vec3_of(const std::array<double, 3>& m)
{
    return {m[0], m[1], m[2]};
}

Mat3 rotation_of(const std::array<double, 4>& q)
{
    return Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix();
}

/// Area and circumference of a plane figure.
struct Outline
{
    double area_m2{0.0};
    double length_m{0.0};
};

double turn_of(const Point2& a, const Point2& b, const Point2& c) noexcept
{
    return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

/// Outline of the convex hull; the length of a segment counts twice.
Outline outline_of(std::vector<Point2> points)
{
    const auto before = [](const Point2& a, const Point2& b)
    { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); };
    std::ranges::sort(points, before);
    std::vector<Point2> hull; // Andrew's monotone chain: first the lower side, then the upper one.
    for (int side = 0; side < 2; ++side)
    {
        const std::size_t first = hull.size();
        for (const Point2& point : points)
        {
            while (hull.size() >= first + 2 &&
                   turn_of(hull[hull.size() - 2], hull.back(), point) <= 0.0)
            {
                hull.pop_back();
            }
            hull.push_back(point);
        }
        hull.pop_back(); // It begins the other side.
        std::ranges::reverse(points);
    }
    Outline outline;
    for (std::size_t i = 0; i < hull.size(); ++i)
    {
        const Point2& next = hull[(i + 1) % hull.size()];
        outline.area_m2 += 0.5 * (hull[i].x() * next.y() - hull[i].y() * next.x());
        outline.length_m += (next - hull[i]).norm();
    }
    return outline;
}

/// Half the least width of the box of the points round their axes.
double half_width(const std::vector<Vec3>& points)
{
    Vec3 low = points.front();
    Vec3 high = points.front();
    for (const Vec3& point : points)
    {
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
    }
    return 0.5 * (high - low).minCoeff();
}

double distance_to_segment(const Vec3& point, const Vec3& from, const Vec3& to)
{
    const Vec3 along = to - from;
    const double length2 = along.squaredNorm();
    const double share =
        length2 > 0.0 ? std::clamp((point - from).dot(along) / length2, 0.0, 1.0) : 0.0;
    return (point - from - share * along).norm();
}

} // namespace

std::optional<BurrShape> burr_shape(const ToolCore& core, double radius_m)
{
    BurrShape shape{{}, radius_m};
    if (std::holds_alternative<PointCore>(core))
    {
        shape.core_m = {Vec3(0.0, 0.0, 0.0)};
    }
    else if (const auto* segment = std::get_if<Segment>(&core))
    {
        shape.core_m = {segment->from, segment->to};
    }
    else if (const auto* box = std::get_if<Box>(&core))
    {
        for (unsigned corner = 0; corner < 8; ++corner)
        {
            const auto sign = [corner](unsigned axis)
            { return (corner >> axis & 1U) != 0 ? 1.0 : -1.0; };
            shape.core_m.push_back(box->half.cwiseProduct(Vec3(sign(0), sign(1), sign(2))));
        }
    }
    else if (const auto* hull = std::get_if<Hull>(&core))
    {
        shape.core_m.assign(hull->vertices().begin(), hull->vertices().end());
    }
    const bool is_round = shape.core_m.size() == 1 || shape.core_m.size() == 2;
    const bool has_volume =
        is_round ? radius_m > 0.0
                 : shape.core_m.size() >= 4 && radius_m == 0.0 && half_width(shape.core_m) > 0.0;
    return has_volume ? std::optional(std::move(shape)) : std::nullopt;
}

BurrLaw::BurrLaw(BurrShape shape, double rate_m3_per_s)
    : shape_(std::move(shape))
    , rate_m3_per_s_(rate_m3_per_s)
    , size_m_(shape_.radius_m > 0.0 ? shape_.radius_m : half_width(shape_.core_m))
{
    TACTUS_ASSERT(size_m_ > 0.0);
    TACTUS_ASSERT(rate_m3_per_s_ > 0.0);
}

/// True if the path since `from_m_` is nearly a straight line to `to_m`. A sweep along another path
/// would cut where the tool never was.
bool BurrLaw::is_straight(const Vec3& to_m, double scale) const
{
    const double bend_m = kBurrBend * size_m_ / scale;
    return std::ranges::all_of(path_m_, [&](const Vec3& place_m)
                               { return distance_to_segment(place_m, from_m_, to_m) <= bend_m; });
}

/// Area of the shadow along `push` of the tool swept by `way_m`, in the world. By Steiner's
/// formula, the radius adds the circumference times it, and a circle.
double BurrLaw::shadow_m2(const Mat3& rotation, const Vec3& way_m, const Vec3& push) const
{
    const Vec3 x = push.unitOrthogonal();
    const Vec3 y = push.cross(x);
    std::vector<Point2> points;
    for (const Vec3& core_m : shape_.core_m)
    {
        const Vec3 turned_m = rotation * core_m;
        const Vec3 moved_m = turned_m + way_m;
        points.emplace_back(turned_m.dot(x), turned_m.dot(y));
        points.emplace_back(moved_m.dot(x), moved_m.dot(y));
    }
    const Outline core = outline_of(std::move(points));
    const double radius_m = shape_.radius_m;
    return core.area_m2 + core.length_m * radius_m + std::numbers::pi * radius_m * radius_m;
}

std::optional<BurrCut> BurrLaw::add(const CutSample& sample)
{
    const Vec3 proxy_m = vec3_of(sample.proxy_m);
    const bool goes_on = last_ && last_->object == sample.object && last_->model == sample.model &&
                         last_->scale == sample.scale && sample.time_ns > last_->time_ns &&
                         sample.time_ns - last_->time_ns <= kContact.ns;
    const CutSample before = std::exchange(last_, sample).value_or(sample);
    const Vec3 before_m = vec3_of(before.proxy_m);
    if (!goes_on)
    {
        volume_m3_ = 0.0;
        from_m_ = proxy_m;
        path_m_.clear();
        return std::nullopt;
    }
    const double passed_s = 1e-9 * static_cast<double>(sample.time_ns - before.time_ns);
    const double path_m = sample.scale * (proxy_m - before_m).norm();
    volume_m3_ += std::min(rate_m3_per_s_ * passed_s, kBurrVolume_m3_per_nm * sample.force_n *
                                                          (path_m + kBurrSpeed_m_per_s * passed_s));
    if (!is_straight(proxy_m, sample.scale) ||
        sample.scale * (proxy_m - from_m_).norm() > kBurrLengthMax * size_m_)
    {
        from_m_ = before_m; // The path before is left as it is; its volume is removed from here on.
        path_m_.clear();
    }
    path_m_.push_back(proxy_m);
    const Mat3 rotation = rotation_of(sample.rotation);
    const Vec3 push = vec3_of(sample.push);
    const double roundness_m = kBurrRoundness * shape_.radius_m;
    const double shadow = shadow_m2(rotation, sample.scale * (proxy_m - from_m_), push);
    volume_m3_ = std::min(volume_m3_, shadow * (kBurrDepthMax * size_m_ + roundness_m));
    const double depth_m = volume_m3_ / shadow - roundness_m;
    const std::int64_t since_ns = sample.time_ns - cut_ns_;
    if (depth_m < kBurrDepthMin * size_m_ || since_ns < kPeriod.ns ||
        (!is_answered_ && since_ns < kAnswer.ns))
    {
        return std::nullopt;
    }
    const Vec3 pushed_m = depth_m / sample.scale * push;
    const BurrCut cut{sample.object,
                      sample.model,
                      rotation,
                      from_m_ + pushed_m,
                      proxy_m + pushed_m,
                      sample.scale,
                      std::exchange(volume_m3_, 0.0)};
    from_m_ = proxy_m;
    path_m_.clear();
    is_answered_ = false;
    cut_ns_ = sample.time_ns;
    return cut;
}

} // namespace tactus::hrtc
