// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

#include "tests/shared/mesh_pair_oracle.hpp"

#include "tests/shared/exact_meet.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace tactus::test
{
namespace
{

Face in_order(Face face)
{
    std::sort(face.begin(), face.end());
    return face;
}

} // namespace

FaceNames::FaceNames(const std::vector<Face>& faces)
{
    for (std::uint32_t i = 0; i < faces.size(); ++i)
    {
        names_.push_back(by_corners_.emplace(in_order(faces[i]), i).first->second);
    }
}

std::optional<std::uint32_t> FaceNames::of(const Model& model, FaceId face) const
{
    if (face.is_none() || face.value >= model.header.counts().face_ids())
    {
        return std::nullopt;
    }
    const PrimId prim = model.forest.find(face);
    if (prim.is_none())
    {
        return std::nullopt;
    }
    const auto found = by_corners_.find(in_order(model.forest.corners_of(prim)));
    return found == by_corners_.end() ? std::nullopt : std::optional(found->second);
}

TriangleTree::TriangleTree(const std::vector<Triangle>& triangles)
{
    std::vector<std::uint32_t> order(triangles.size());
    std::iota(order.begin(), order.end(), 0U);
    nodes_.reserve(2 * triangles.size());
    build(triangles, order, 0, static_cast<std::uint32_t>(triangles.size()));
    refit(triangles);
}

void TriangleTree::build(const std::vector<Triangle>& triangles, std::vector<std::uint32_t>& order,
                         std::uint32_t first, std::uint32_t count)
{
    const std::size_t index = nodes_.size();
    nodes_.emplace_back();
    if (count == 1)
    {
        nodes_[index].triangle = order[first];
        return;
    }
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 high = -low;
    const auto middle = [&](std::uint32_t i)
    { return Vec3(triangles[i][0] + triangles[i][1] + triangles[i][2]); };
    for (std::uint32_t i = first; i < first + count; ++i)
    {
        low = low.cwiseMin(middle(order[i]));
        high = high.cwiseMax(middle(order[i]));
    }
    Eigen::Index axis = 0;
    (high - low).maxCoeff(&axis);
    const auto begin = order.begin() + static_cast<std::ptrdiff_t>(first);
    std::nth_element(begin, begin + count / 2, begin + count,
                     [&](std::uint32_t a, std::uint32_t b)
                     { return middle(a)[axis] < middle(b)[axis]; });
    build(triangles, order, first, count / 2);
    nodes_[index].right = static_cast<std::uint32_t>(nodes_.size());
    build(triangles, order, first + count / 2, count - count / 2);
}

void TriangleTree::refit(const std::vector<Triangle>& triangles)
{
    for (std::size_t i = nodes_.size(); i-- > 0;)
    {
        Node& node = nodes_[i];
        if (node.right == 0)
        {
            const Triangle& t = triangles[node.triangle];
            node.low = t[0].cwiseMin(t[1]).cwiseMin(t[2]);
            node.high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
            continue;
        }
        node.low = nodes_[i + 1].low.cwiseMin(nodes_[node.right].low);
        node.high = nodes_[i + 1].high.cwiseMax(nodes_[node.right].high);
    }
}

namespace
{

std::vector<Triangle> widened(const std::vector<Face>& faces)
{
    std::vector<Triangle> triangles;
    triangles.reserve(faces.size());
    for (const Face& face : faces)
    {
        triangles.push_back({to_vec3(face[0]), to_vec3(face[1]), to_vec3(face[2])});
    }
    return triangles;
}

std::vector<Vec3> normals_of(const std::vector<Triangle>& triangles)
{
    std::vector<Vec3> normals;
    normals.reserve(triangles.size());
    for (const Triangle& t : triangles)
    {
        normals.push_back((t[1] - t[0]).cross(t[2] - t[0]).normalized());
    }
    return normals;
}

/// Gap between the projections of two triangles on a line; negative if they overlap.
double gap_along(const Vec3& direction, const Triangle& a, const Triangle& b)
{
    const auto [a_low, a_high] =
        std::minmax({direction.dot(a[0]), direction.dot(a[1]), direction.dot(a[2])});
    const auto [b_low, b_high] =
        std::minmax({direction.dot(b[0]), direction.dot(b[1]), direction.dot(b[2])});
    return std::max(b_low - a_high, a_low - b_high);
}

/// Orthonormal matrix that a frame makes of a device's rotation.
Mat3 orthonormal(const Mat3& matrix)
{
    Mat3 result;
    const Vec3 first = matrix.col(0).normalized();
    const Vec3 second = matrix.col(1) - first.dot(matrix.col(1)) * first;
    result.col(0) = first;
    result.col(1) = second.normalized();
    result.col(2) = first.cross(result.col(1));
    return result;
}

template <typename Real>
Point<Real> difference_of(const Point<Real>& a, const Point<Real>& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

template <typename Real>
Real corner_to_face(const Point<Real>& corner, const std::array<Point<Real>, 3>& face)
{
    return BasicDistanceOracle<Real>::distance({difference_of(face[0], corner),
                                                difference_of(face[1], corner),
                                                difference_of(face[2], corner)});
}

/// Distance if both are nearest within their ends; otherwise some corner is nearest.
template <typename Real>
Real edge_to_edge(const Point<Real>& p, const Point<Real>& q, const Point<Real>& a,
                  const Point<Real>& b)
{
    const Point<Real> u = difference_of(q, p);
    const Point<Real> v = difference_of(b, a);
    const Point<Real> w = difference_of(p, a);
    const Real uv = dot(u, v);
    const Real vv = dot(v, v);
    const Real determinant = dot(u, u) * vv - uv * uv;
    const Real s = uv * dot(v, w) - vv * dot(u, w);
    if (!(determinant > 0) || s <= 0 || s >= determinant)
    {
        return BasicDistanceOracle<Real>::kInfinity;
    }
    const Point<Real> from = combined(p, s / determinant, u, Real{0}, u);
    return BasicDistanceOracle<Real>::to_segment(difference_of(a, from), difference_of(b, from));
}

template <typename Real>
Real distance_of(const std::array<Point<Real>, 3>& a, const std::array<Point<Real>, 3>& b)
{
    Real least = BasicDistanceOracle<Real>::kInfinity;
    for (std::size_t i = 0; i < 3; ++i)
    {
        least = std::min({least, corner_to_face(a[i], b), corner_to_face(b[i], a)});
        for (std::size_t j = 0; j < 3; ++j)
        {
            least = std::min(least, edge_to_edge(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]));
        }
    }
    return least;
}

template <typename Real, typename Corner>
std::array<Point<Real>, 3> in_precision(const std::array<Corner, 3>& triangle)
{
    std::array<Point<Real>, 3> result{};
    for (std::size_t i = 0; i < 3; ++i)
    {
        const Corner& corner = triangle[i];
        result[i] = {static_cast<Real>(corner[0]), static_cast<Real>(corner[1]),
                     static_cast<Real>(corner[2])};
    }
    return result;
}

} // namespace

MeshPairOracle::MeshPairOracle(const TestModel& tool, const TestModel& object)
    : tool_(tool)
    , tool_faces_(widened(tool.faces))
    , placed_faces_(tool_faces_)
    , object_faces_(widened(object.faces))
    , tool_normals_(normals_of(tool_faces_))
    , normals_(normals_of(object_faces_))
    , tool_tree_(tool_faces_)
    , object_tree_(object_faces_)
    , origin_m_(tool.origin_m[0], tool.origin_m[1], tool.origin_m[2])
{
}

void MeshPairOracle::place(const ObjectPose& pose, const ToolState& tool)
{
    const Similarity placement = in_frame(pose, {orthonormal(tool.rotation), tool.position_m, 1.0});
    rotation_ = placement.rotation;
    double size_m = 0.0;
    for (std::size_t i = 0; i < tool_faces_.size(); ++i)
    {
        for (std::size_t corner = 0; corner < 3; ++corner)
        {
            const Vec3 own_m = tool_faces_[i][corner] + origin_m_;
            placed_faces_[i][corner] =
                placement.translation_m + placement.scale * (placement.rotation * own_m);
            size_m = std::max(size_m, placed_faces_[i][corner].norm() + own_m.norm() / pose.scale);
        }
    }
    tool_tree_.refit(placed_faces_);
    scale_ = pose.scale;
    const Vec3 relative_m = tool.position_m - pose.translation_m;
    margin_m_ = 1e-13 * (size_m + (relative_m.norm() + tool.position_m.norm()) / scale_);

    using WideMatrix = Eigen::Matrix<long double, 3, 3>;
    const WideMatrix back =
        pose.rotation.cast<long double>().inverse() / static_cast<long double>(scale_);
    const WideMatrix turned = back * tool.rotation.cast<long double>();
    const Eigen::Matrix<long double, 3, 1> origin =
        back * (tool.position_m.cast<long double>() - pose.translation_m.cast<long double>());
    for (std::size_t i = 0; i < 3; ++i)
    {
        const auto row = static_cast<Eigen::Index>(i);
        wide_rows_[i] = {turned(row, 0), turned(row, 1), turned(row, 2)};
        wide_origin_[i] = origin[row];
    }
}

MeshPairOracle::WideTriangle MeshPairOracle::ideal_tool_face(std::uint32_t face) const
{
    WideTriangle result{};
    for (std::size_t corner = 0; corner < 3; ++corner)
    {
        WidePoint own{};
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            own[axis] = static_cast<long double>(tool_.faces[face][corner][axis]) +
                        static_cast<long double>(tool_.origin_m[axis]);
        }
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            result[corner][axis] = wide_origin_[axis] + dot(wide_rows_[axis], own);
        }
    }
    return result;
}

bool MeshPairOracle::do_meet(const FacePair& faces) const
{
    return exactly_meet(placed_faces_[faces.tool_face], object_faces_[faces.face]);
}

template <typename Real>
Real MeshPairOracle::distance(const FacePair& faces) const
{
    if (do_meet(faces))
    {
        return 0;
    }
    return static_cast<Real>(scale_) *
           distance_of(in_precision<Real>(ideal_tool_face(faces.tool_face)),
                       in_precision<Real>(object_faces_[faces.face]));
}

template long double MeshPairOracle::distance<long double>(const FacePair&) const;
#if defined(__SIZEOF_FLOAT128__)
template Quad MeshPairOracle::distance<Quad>(const FacePair&) const;
#endif

double MeshPairOracle::gap_m(const FacePair& faces) const
{
    const Triangle& a = placed_faces_[faces.tool_face];
    const Triangle& b = object_faces_[faces.face];
    const Vec3 between = (a[0] + a[1] + a[2] - b[0] - b[1] - b[2]).normalized();
    return std::max({gap_along(between, a, b), gap_along(normals_[faces.face], a, b),
                     gap_along(rotation_ * tool_normals_[faces.tool_face], a, b)});
}

MeshPairOracle::Nearest MeshPairOracle::nearest()
{
    Nearest best{distance(last_nearest_), last_nearest_};
    const auto limit = [&]
    {
        const auto distance_m = static_cast<double>(best.distance_m);
        return distance_m > 0.0 ? distance_m / scale_ + margin_m_ : -1.0;
    };
    TriangleTree::visit_pairs(tool_tree_, object_tree_, limit,
                              [&](std::uint32_t tool_face, std::uint32_t face)
                              {
                                  const FacePair faces{tool_face, face};
                                  const long double found =
                                      gap_m(faces) > limit() ? best.distance_m : distance(faces);
                                  if (found < best.distance_m)
                                  {
                                      best = {found, faces};
                                  }
                              });
    last_nearest_ = best.faces;
    return best;
}

std::vector<FacePair> MeshPairOracle::meeting() const
{
    std::vector<FacePair> pairs;
    TriangleTree::visit_pairs(
        tool_tree_, object_tree_, [] { return 0.0; },
        [&](std::uint32_t tool_face, std::uint32_t face)
        {
            if (do_meet({tool_face, face}))
            {
                pairs.push_back({tool_face, face});
            }
        });
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

std::vector<FacePair> MeshPairOracle::within(double distance_m, std::size_t enough) const
{
    std::vector<FacePair> pairs;
    const auto limit = [&]
    { return pairs.size() < enough ? distance_m / scale_ + margin_m_ : -1.0; };
    TriangleTree::visit_pairs(
        tool_tree_, object_tree_, limit,
        [&](std::uint32_t tool_face, std::uint32_t face)
        {
            if (distance({tool_face, face}) <= static_cast<long double>(distance_m))
            {
                pairs.push_back({tool_face, face});
            }
        });
    return pairs;
}

} // namespace tactus::test
