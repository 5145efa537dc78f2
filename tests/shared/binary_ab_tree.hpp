// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/changed_face.hpp"
#include "tests/shared/brute_force.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <set>
#include <span>
#include <vector>

namespace tactus::test
{

/// The distance question as an oracle answers it: L and U of all active faces, and which exact ones
/// are within reach.
struct OracleAnswer
{
    long double lower_m{std::numeric_limits<long double>::infinity()};
    long double upper_m{std::numeric_limits<long double>::infinity()};
    std::set<std::uint32_t> exact_within;
    std::uint64_t nodes_visited{0};

    /// Takes one active face into account, by brute_distance().
    void add(const ChangedFace& face, const Vec3& center_m, double reach_m, float quantum_m);
};

/// The paper's AB-Tree, as plainly as it can be written: a binary tree over all faces of the finest
/// mesh, one face a leaf, in which every node is inactive, active or deformed. A face becomes
/// active or changes: its leaf and all nodes above it are deformed. refit() visits the deformed
/// nodes and no other. Shares nothing with the 8-wide tree but the order of the faces.
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

    /// `faces` are those of the finest mesh in the order of their paths; each is halved in the
    /// middle, so all leaves are on the two lowest levels.
    BinaryAbTree(std::span<const FaceId> faces, float quantum_m);

    void set(const ChangedFace& face);
    void remove(FaceId face);
    /// Nodes visited, leaves included.
    std::uint64_t refit();

    [[nodiscard]] OracleAnswer query(const Vec3& center_m, double reach_m) const;

    [[nodiscard]] Status status(std::uint32_t node) const { return nodes_[node].status; }
    [[nodiscard]] std::uint32_t parent(std::uint32_t node) const { return nodes_[node].parent; }
    /// The index list: the leaf of a face.
    [[nodiscard]] std::uint32_t leaf_of(FaceId face) const { return leaf_of_[face.value]; }
    static constexpr std::uint32_t kRoot = 0;

private:
    struct Node
    {
        std::array<double, 3> low{};
        std::array<double, 3> high{};
        std::uint32_t parent{kNone};
        std::array<std::uint32_t, 2> children{kNone, kNone};
        std::uint32_t face{kNone}; ///< Of a leaf: its place in `faces_`.
        Status status{Status::inactive};
    };

    std::uint32_t build(std::uint32_t begin, std::uint32_t end, std::uint32_t parent);
    void mark_deformed(std::uint32_t leaf);
    void refit_below(std::uint32_t node, std::uint64_t& visited);
    void refit_leaf(Node& leaf) const;
    [[nodiscard]] double distance_sq_to(const Node& node, const Vec3& point) const;

    float quantum_m_;
    std::vector<ChangedFace> faces_; ///< In path order; face none while inactive.
    std::vector<FaceId> order_;
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> leaf_of_;
};

} // namespace tactus::test
