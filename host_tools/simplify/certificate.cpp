// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/certificate.hpp"

#include "host_tools/mesh/mesh_places.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>

namespace tactus
{

namespace
{

constexpr std::uint32_t kNone = FragmentPool::kNone;

/// Share of the diagonal up to which pieces stay uncut: finer cuts cost time without benefit.
constexpr double kUncutFloor = 2e-6;

/// Rounding of the distance kernel and of a fragment's corners, in quanta and relative: more than
/// ten times the largest error (see DistanceTriangle). It also keeps the bound of a changed face
/// above zero, since zero means original.
constexpr double kSlackQuanta = 1e-6;
constexpr double kSlackFactor = 1 + 1e-12;

constexpr std::array<TrianglePoint, 3> kWholeTriangle{
    {{0, 0}, {TrianglePoint::kOne, 0}, {0, TrianglePoint::kOne}}};

float float_not_below(double value) noexcept
{
    const auto nearest = static_cast<float>(value);
    return static_cast<double>(nearest) < value
               ? std::nextafter(nearest, std::numeric_limits<float>::infinity())
               : nearest;
}

/// Visits the items of all linked lists, one item of each list in turn, so that the cache misses of
/// the lists overlap.
template <typename Next, typename Visit>
void visit_lists(std::span<std::uint32_t> heads, const Next& next, const Visit& visit)
{
    bool more = true;
    while (more)
    {
        more = false;
        for (std::uint32_t& head : heads)
        {
            if (head != kNone)
            {
                visit(head);
                head = next(head);
                more = true;
            }
        }
    }
}

} // namespace

Certificate::Certificate(const QuantisedMesh& mesh, unsigned workers)
    : mesh_(mesh)
    , diagonal_(box_of(mesh).diagonal().norm())
    , errors_(mesh.faces.size(), 0)
    , first_whole_(mesh.faces.size())
    , next_whole_(mesh.faces.size(), kNone)
    , first_fragment_(mesh.faces.size(), kNone)
    , fragment_count_(mesh.faces.size(), 0)
    , pool_(workers)
    , scratch_(workers)
{
    std::iota(first_whole_.begin(), first_whole_.end(), 0U);
}

void Certificate::reassign(const Star& star, unsigned worker)
{
    Scratch& scratch = scratch_[worker];
    take_pieces(star, scratch);
    merge_back(scratch, worker);
    scratch.settler.begin(mesh_, star);
    place_corners(scratch);
    scratch.settler.measure(kUncutFloor * diagonal_);
    scratch.bound.fill(0);
    for (std::size_t i = 0; i < scratch.triangles.size(); ++i)
    {
        give_triangle(scratch.triangles[i], scratch.parts[i], star, worker);
    }
    for (std::size_t i = 0; i < scratch.fragments.size(); ++i)
    {
        give_fragment(scratch.fragments[i], scratch.parts[scratch.triangles.size() + i], star,
                      worker);
    }
    for (std::uint32_t i = 0; i < star.fan_size; ++i)
    {
        errors_[star.faces[2 + i]] =
            float_not_below(scratch.bound[i] * kSlackFactor + kSlackQuanta);
    }
}

void Certificate::collect_pieces(std::span<const std::uint32_t> faces,
                                 std::vector<std::uint32_t>& triangles,
                                 std::vector<std::uint32_t>& fragments) const
{
    triangles.clear();
    fragments.clear();
    std::array<std::uint32_t, kMaxStarFaces> whole{};
    std::array<std::uint32_t, kMaxStarFaces> fragment{};
    for (std::size_t i = 0; i < faces.size(); ++i)
    {
        const bool missing = faces[i] == Collapse::kNoFace;
        whole[i] = missing ? kNone : first_whole_[faces[i]];
        fragment[i] = missing ? kNone : first_fragment_[faces[i]];
    }
    visit_lists(
        std::span{whole}.first(faces.size()), [&](std::uint32_t t) { return next_whole_[t]; },
        [&](std::uint32_t t) { triangles.push_back(t); });
    visit_lists(
        std::span{fragment}.first(faces.size()), [&](std::uint32_t i) { return pool_[i].next; },
        [&](std::uint32_t i) { fragments.push_back(i); });
}

void Certificate::take_pieces(const Star& star, Scratch& scratch)
{
    const auto faces = std::span{star.faces}.first(2 + star.fan_size);
    collect_pieces(faces, scratch.triangles, scratch.fragments);
    for (const std::uint32_t face : faces)
    {
        if (face != Collapse::kNoFace)
        {
            first_whole_[face] = kNone;
            first_fragment_[face] = kNone;
        }
    }
}

/// Restores triangles whose fragments are all in the star. A concurrent star can change a
/// triangle's count only if it has a fragment of the triangle. Then the count stays above this
/// star's count in any case, so the result does not depend on the order.
void Certificate::merge_back(Scratch& scratch, unsigned worker)
{
    scratch.map.reset(scratch.fragments.size());
    scratch.counts.assign(scratch.fragments.size(), 0);
    for (const std::uint32_t fragment : scratch.fragments)
    {
        ++scratch.counts[scratch.map.index_of(pool_[fragment].triangle)];
    }
    std::size_t kept = 0;
    for (const std::uint32_t fragment : scratch.fragments)
    {
        const std::uint32_t triangle = pool_[fragment].triangle;
        std::uint32_t& count = scratch.counts[scratch.map.index_of(triangle)];
        // Relaxed: other workers' data of the triangle is read only after the threads are joined.
        const std::uint32_t total =
            std::atomic_ref(fragment_count_[triangle]).load(std::memory_order_relaxed);
        if (count != kNone && count != total)
        {
            scratch.fragments[kept++] = fragment;
            continue;
        }
        if (count != kNone)
        {
            scratch.triangles.push_back(triangle);
            count = kNone;
        }
        pool_.give_back(worker, fragment);
    }
    scratch.fragments.resize(kept);
}

/// Adds the corners of all pieces to the settler. Whole triangles share one point for each vertex;
/// corners of fragments are added separately, since few are shared.
void Certificate::place_corners(Scratch& scratch) const
{
    scratch.parts.clear();
    scratch.map.reset(3 * scratch.triangles.size());
    for (const std::uint32_t triangle : scratch.triangles)
    {
        Part part{kWholeTriangle, {}, 0};
        for (std::size_t i = 0; i < 3; ++i)
        {
            const std::uint32_t vertex = mesh_.faces[triangle][i];
            const std::uint32_t known = scratch.map.size();
            part.points[i] = scratch.map.index_of(vertex);
            if (part.points[i] == known)
            {
                scratch.settler.add_point(grid_point(mesh_, vertex));
            }
        }
        scratch.parts.push_back(part);
    }
    for (const std::uint32_t index : scratch.fragments)
    {
        const Fragment& fragment = pool_[index];
        const TriangleFrame frame = frame_of(mesh_, fragment.triangle);
        Part part{fragment.corners, {}, fragment.generation};
        for (std::size_t i = 0; i < 3; ++i)
        {
            part.points[i] = scratch.settler.add_point(frame.point(fragment.corners[i]));
        }
        scratch.parts.push_back(part);
    }
}

void Certificate::give_triangle(std::uint32_t triangle, const Part& part, const Star& star,
                                unsigned worker)
{
    Scratch& scratch = scratch_[worker];
    const auto settled = scratch.settler.settle(part, mesh_, triangle);
    if (settled.size() == 1)
    {
        const Assignment& given = settled.front();
        const std::uint32_t face = star.faces[2 + given.place];
        next_whole_[triangle] = first_whole_[face];
        first_whole_[face] = triangle;
        scratch.bound[given.place] = std::max(scratch.bound[given.place], std::sqrt(given.squared));
        return;
    }
    // No other worker has a part of a whole triangle.
    fragment_count_[triangle] = static_cast<std::uint32_t>(settled.size());
    for (const Assignment& given : settled)
    {
        add_fragment(pool_.take(worker), triangle, given, star, scratch);
    }
}

void Certificate::give_fragment(std::uint32_t fragment, const Part& part, const Star& star,
                                unsigned worker)
{
    Scratch& scratch = scratch_[worker];
    const std::uint32_t triangle = pool_[fragment].triangle;
    const auto settled = scratch.settler.settle(part, mesh_, triangle);
    add_fragment(fragment, triangle, settled.front(), star, scratch);
    for (const Assignment& given : settled.subspan(1))
    {
        add_fragment(pool_.take(worker), triangle, given, star, scratch);
    }
    // Relaxed: the counterpart of the load in merge_back(), see there.
    std::atomic_ref(fragment_count_[triangle])
        .fetch_add(static_cast<std::uint32_t>(settled.size() - 1), std::memory_order_relaxed);
}

void Certificate::add_fragment(std::uint32_t fragment, std::uint32_t triangle,
                               const Assignment& given, const Star& star, Scratch& scratch)
{
    const std::uint32_t face = star.faces[2 + given.place];
    pool_[fragment] = {given.part.at, triangle, first_fragment_[face], given.part.generation};
    first_fragment_[face] = fragment;
    const double gaps = given.part.generation * frame_of(mesh_, triangle).rounding();
    double& bound = scratch.bound[given.place];
    bound = std::max(bound, std::sqrt(given.squared) + gaps);
}

FaceSamples Certificate::sample(std::uint32_t face, unsigned worker)
{
    Scratch& scratch = scratch_[worker];
    collect_pieces(std::span{&face, 1}, scratch.triangles, scratch.fragments);
    const std::size_t whole = scratch.triangles.size();
    const std::size_t count = whole + scratch.fragments.size();
    const std::size_t step =
        std::max<std::size_t>(1, (count + FaceSamples::capacity() - 1) / FaceSamples::capacity());
    const auto weight = static_cast<double>(step);
    FaceSamples samples;
    for (std::size_t i = step / 2; i < count; i += step)
    {
        if (i < whole)
        {
            samples.push_back(middle_of(scratch.triangles[i], kWholeTriangle, weight));
            continue;
        }
        const Fragment& fragment = pool_[scratch.fragments[i - whole]];
        samples.push_back(middle_of(fragment.triangle, fragment.corners, weight));
    }
    return samples;
}

/// Middle of a piece, and its area times `weight`.
SurfacePoint Certificate::middle_of(std::uint32_t triangle,
                                    const std::array<TrianglePoint, 3>& corners,
                                    double weight) const
{
    const TriangleFrame frame = frame_of(mesh_, triangle);
    std::array<double, 3> x{};
    std::array<double, 3> y{};
    for (std::size_t i = 0; i < 3; ++i)
    {
        x[i] = corners[i].x * (1.0 / TrianglePoint::kOne);
        y[i] = corners[i].y * (1.0 / TrianglePoint::kOne);
    }
    const double share = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    const double area = 0.5 * weight * std::abs(share) * frame.side_x.cross(frame.side_y).norm();
    const Vec3 middle = frame.origin + (x[0] + x[1] + x[2]) / 3 * frame.side_x +
                        (y[0] + y[1] + y[2]) / 3 * frame.side_y;
    return {static_cast<float>(middle.x()), static_cast<float>(middle.y()),
            static_cast<float>(middle.z()), static_cast<float>(area)};
}

} // namespace tactus
