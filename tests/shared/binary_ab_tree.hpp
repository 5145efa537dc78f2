// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/ids.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::test
{

/// The 3DIM 2005 paper's AB-Tree: a binary tree over all faces of the finest mesh, one face a leaf,
/// in which every node is inactive, active or deformed. When a face becomes active, its leaf and
/// all nodes above it are deformed until refit(). Shares only the order of the faces with the
/// 8-wide tree. No boxes.
class BinaryAbTree
{
public:
    enum class Status : std::uint8_t
    {
        inactive,
        active,
        deformed,
    };
    static constexpr std::uint32_t kNone = 0xFFFF'FFFFU;

    /// Builds from the faces of the finest mesh in the order of their paths, each range halved in
    /// the middle, so that all leaves are on the two lowest levels.
    explicit BinaryAbTree(std::span<const FaceId> faces)
    {
        nodes_.reserve(2 * faces.size());
        build(faces, kNone);
    }

    void set(FaceId face)
    {
        for (std::uint32_t node = leaf_of(face); node != kNone; node = nodes_[node].parent)
        {
            nodes_[node].status = Status::deformed;
        }
    }
    void refit()
    {
        for (Node& node : nodes_)
        {
            node.status = node.status == Status::deformed ? Status::active : node.status;
        }
    }

    [[nodiscard]] Status status(std::uint32_t node) const { return nodes_[node].status; }
    [[nodiscard]] std::uint32_t parent(std::uint32_t node) const { return nodes_[node].parent; }
    /// Leaf of a face, from the index list.
    [[nodiscard]] std::uint32_t leaf_of(FaceId face) const { return leaf_of_[face.value]; }

private:
    struct Node
    {
        std::uint32_t parent{kNone};
        Status status{Status::inactive};
    };

    void build(std::span<const FaceId> faces, std::uint32_t parent)
    {
        const auto index = static_cast<std::uint32_t>(nodes_.size());
        nodes_.push_back({parent});
        if (faces.size() > 1)
        {
            build(faces.first(faces.size() / 2), index);
            build(faces.subspan(faces.size() / 2), index);
            return;
        }
        leaf_of_.resize(std::max(leaf_of_.size(), std::size_t{faces[0].value} + 1), kNone);
        leaf_of_[faces[0].value] = index;
    }

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> leaf_of_;
};

} // namespace tactus::test
