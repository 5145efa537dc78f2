// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/mesh_places.hpp"
#include "host_tools/simplify/certificate.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>
#include <limits>

namespace tactus
{

namespace
{

/// Multiple of the lower bound up to which a piece stays uncut.
constexpr double kUncutFactor = 1.05;

/// Maximum number of parts of a piece. With three parts a cut, only pieces at many edges that meet
/// in a small triangle exceed it; their bound is then only looser.
constexpr std::size_t kPartsMax = 48;

Vec3 unit_or_zero(const Vec3& v) noexcept
{
    const double length = v.norm();
    return length > 0 ? Vec3(v / length) : Vec3(Vec3::Zero());
}

} // namespace

void PieceSettler::begin(const QuantisedMesh& mesh, const Star& star)
{
    const Vec3 parent = grid_point(mesh, star.parent);
    Vec3 rim = grid_point(mesh, star.rim[0]);
    Vec3 last_normal = Vec3::Zero();
    fan_size_ = star.fan_size;
    planes_.clear();
    points_.clear();
    for (std::uint32_t i = 0; i < fan_size_; ++i)
    {
        const Vec3 next_rim = grid_point(mesh, star.rim[i + 1]);
        faces_[i] = DistanceTriangle(parent, rim, next_rim);
        squared_[i].clear();
        const Vec3 normal = unit_or_zero(faces_[i].normal());
        if (i > 0)
        {
            const Vec3 along = rim - parent;
            planes_.push_back({parent, along, along.cross(normal + last_normal)});
        }
        rim = next_rim;
        last_normal = normal;
    }
}

std::uint32_t PieceSettler::add_point(const Vec3& point)
{
    points_.push_back(point);
    return static_cast<std::uint32_t>(points_.size() - 1);
}

void PieceSettler::measure_new_points()
{
    for (std::uint32_t i = 0; i < fan_size_; ++i)
    {
        const std::size_t begin = squared_[i].size();
        squared_[i].resize(points_.size());
        faces_[i].squared_distances(points_, begin, squared_[i].data());
    }
}

void PieceSettler::measure(double floor_quanta)
{
    measure_new_points();
    double lower_bound = 0;
    for (std::size_t point = 0; point < points_.size(); ++point)
    {
        double nearest = std::numeric_limits<double>::max();
        for (std::uint32_t i = 0; i < fan_size_; ++i)
        {
            nearest = std::min(nearest, squared_[i][point]);
        }
        lower_bound = std::max(lower_bound, nearest);
    }
    accepted_ = std::max(kUncutFactor * kUncutFactor * lower_bound, floor_quanta * floor_quanta);
}

Assignment PieceSettler::assign_to_best(const Part& part) const noexcept
{
    Assignment best{part, 0, std::numeric_limits<double>::max()};
    for (std::uint32_t i = 0; i < fan_size_; ++i)
    {
        const double* squared = squared_[i].data();
        const double reach =
            std::max({squared[part.points[0]], squared[part.points[1]], squared[part.points[2]]});
        if (reach < best.squared)
        {
            best.place = i;
            best.squared = reach;
        }
    }
    return best;
}

std::span<const Assignment> PieceSettler::settle(const Part& piece, const QuantisedMesh& mesh,
                                                 std::uint32_t triangle)
{
    const Assignment uncut = assign_to_best(piece);
    settled_.assign(1, uncut);
    if (uncut.squared <= accepted_)
    {
        return settled_;
    }
    const TriangleFrame frame = frame_of(mesh, triangle);
    open_.swap(settled_);
    settled_.clear();
    for (const CutPlane& plane : planes_)
    {
        cut_open_parts(plane, frame);
    }
    settled_.insert(settled_.end(), open_.begin(), open_.end());
    // If all parts are assigned to one face, the cuts are undone.
    const std::uint32_t place = settled_.front().place;
    if (std::ranges::all_of(settled_, [=](const Assignment& a) { return a.place == place; }))
    {
        const double squared = std::ranges::max(settled_, {}, &Assignment::squared).squared;
        settled_.assign(1, Assignment{piece, place, squared});
    }
    return settled_;
}

void PieceSettler::cut_open_parts(const CutPlane& plane, const TriangleFrame& frame)
{
    next_open_.clear();
    for (const Assignment& whole : open_)
    {
        const bool room = settled_.size() + open_.size() + next_open_.size() < kPartsMax;
        const CutParts parts = room ? cut(whole.part, frame, plane, points_) : CutParts{};
        if (parts.empty())
        {
            next_open_.push_back(whole);
            continue;
        }
        measure_new_points();
        for (const Part& part : parts)
        {
            const Assignment best = assign_to_best(part);
            (best.squared <= accepted_ ? settled_ : next_open_).push_back(best);
        }
    }
    open_.swap(next_open_);
}

} // namespace tactus
