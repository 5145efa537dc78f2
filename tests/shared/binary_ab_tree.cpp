// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/binary_ab_tree.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::test
{

namespace
{

double error_m(const ChangedFace& face, float quantum_m)
{
    return static_cast<double>(error_in_quanta(face.error)) * static_cast<double>(quantum_m);
}

} // namespace

void OracleAnswer::add(const ChangedFace& face, const Vec3& center_m, double reach_m,
                       float quantum_m)
{
    const long double distance = brute_distance(center_m, face.corners_m);
    lower_m = std::min(lower_m, distance - static_cast<long double>(error_m(face, quantum_m)));
    if (face.error == 0)
    {
        upper_m = std::min(upper_m, distance);
        if (distance <= static_cast<long double>(reach_m))
        {
            exact_within.insert(face.face.value);
        }
        return;
    }
    for (const Vec3f& corner : face.corners_m)
    {
        upper_m = std::min(upper_m, brute_distance(center_m, Face{corner, corner, corner}));
    }
}

BinaryAbTree::BinaryAbTree(std::span<const FaceId> faces, float quantum_m)
    : quantum_m_(quantum_m), faces_(faces.size()), order_(faces.begin(), faces.end())
{
    std::uint32_t largest = 0;
    for (const FaceId face : faces)
    {
        largest = std::max(largest, face.value);
    }
    leaf_of_.assign(std::size_t{largest} + 1, kNone);
    nodes_.reserve(2 * faces.size());
    build(0, static_cast<std::uint32_t>(faces.size()), kNone);
}

std::uint32_t BinaryAbTree::build(std::uint32_t begin, std::uint32_t end, std::uint32_t parent)
{
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back().parent = parent;
    if (end - begin == 1)
    {
        nodes_[index].face = begin;
        leaf_of_[order_[begin].value] = index;
        return index;
    }
    const std::uint32_t middle = begin + (end - begin) / 2;
    const std::uint32_t left = build(begin, middle, index);
    const std::uint32_t right = build(middle, end, index);
    nodes_[index].children = {left, right};
    return index;
}

void BinaryAbTree::set(const ChangedFace& face)
{
    const std::uint32_t leaf = leaf_of_[face.face.value];
    faces_[nodes_[leaf].face] = face;
    mark_deformed(leaf);
}

void BinaryAbTree::remove(FaceId face)
{
    const std::uint32_t leaf = leaf_of_[face.value];
    faces_[nodes_[leaf].face] = ChangedFace{};
    mark_deformed(leaf);
}

void BinaryAbTree::mark_deformed(std::uint32_t leaf)
{
    for (std::uint32_t node = leaf; node != kNone && nodes_[node].status != Status::deformed;
         node = nodes_[node].parent)
    {
        nodes_[node].status = Status::deformed;
    }
}

std::uint64_t BinaryAbTree::refit()
{
    std::uint64_t visited = 0;
    refit_below(kRoot, visited);
    return visited;
}

void BinaryAbTree::refit_below(std::uint32_t index, std::uint64_t& visited)
{
    if (nodes_[index].status != Status::deformed)
    {
        return;
    }
    ++visited;
    if (nodes_[index].face != kNone)
    {
        refit_leaf(nodes_[index]);
        return;
    }
    Node& node = nodes_[index];
    node.status = Status::inactive;
    node.low.fill(std::numeric_limits<double>::infinity());
    node.high.fill(-std::numeric_limits<double>::infinity());
    for (const std::uint32_t child_index : node.children)
    {
        refit_below(child_index, visited);
        const Node& child = nodes_[child_index];
        if (child.status == Status::inactive)
        {
            continue;
        }
        node.status = Status::active;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            node.low[axis] = std::min(node.low[axis], child.low[axis]);
            node.high[axis] = std::max(node.high[axis], child.high[axis]);
        }
    }
}

void BinaryAbTree::refit_leaf(Node& leaf) const
{
    const ChangedFace& face = faces_[leaf.face];
    leaf.status = face.face.is_none() ? Status::inactive : Status::active;
    const double margin = error_m(face, quantum_m_);
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const auto [low, high] = std::minmax(
            {face.corners_m[0][axis], face.corners_m[1][axis], face.corners_m[2][axis]});
        leaf.low[axis] = static_cast<double>(low) - margin;
        leaf.high[axis] = static_cast<double>(high) + margin;
    }
}

double BinaryAbTree::distance_sq_to(const Node& node, const Vec3& point) const
{
    double sum = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const double at = point[static_cast<Eigen::Index>(axis)];
        const double gap = std::max({node.low[axis] - at, at - node.high[axis], 0.0});
        sum += gap * gap;
    }
    return sum * (1.0 - 1e-12); // Rounding must never make a box too far.
}

OracleAnswer BinaryAbTree::query(const Vec3& center_m, double reach_m) const
{
    OracleAnswer answer;
    std::vector<std::uint32_t> stack{kRoot};
    while (!stack.empty())
    {
        const Node& node = nodes_[stack.back()];
        stack.pop_back();
        const long double bound = std::max(answer.upper_m, static_cast<long double>(reach_m));
        if (node.status == Status::inactive ||
            static_cast<long double>(distance_sq_to(node, center_m)) > bound * bound)
        {
            continue;
        }
        ++answer.nodes_visited;
        if (node.face != kNone)
        {
            answer.add(faces_[node.face], center_m, reach_m, quantum_m_);
            continue;
        }
        stack.push_back(node.children[1]);
        stack.push_back(node.children[0]);
    }
    return answer;
}

} // namespace tactus::test
