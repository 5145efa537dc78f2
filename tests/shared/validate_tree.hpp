// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/ab_tree.hpp"
#include "tests/shared/volume_oracle.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <vector>

namespace tactus::test
{

/// Walks a whole AB-Tree after refit() and compares it with the faces that should be in it.
///
/// Boxes are computed again from the faces, bottom-up and with arithmetic of its own, and must be
/// equal bit for bit: so the tree equals one that was refitted from scratch (invariant I6).
template <typename Tree>
class TreeValidator
{
public:
    /// `faces` are all faces that were handed to the tree and not removed since.
    [[nodiscard]] static std::vector<std::string> faults(const Tree& tree,
                                                         std::span<const ChangedFace> faces)
    {
        TreeValidator validator(tree, faces);
        validator.walk_all();
        return validator.faults_;
    }

private:
    using Box = typename Tree::Box;
    using Node = typename Tree::Node;
    using Oracle = VolumeOracle<typename Tree::Volume>;

    struct Subtree
    {
        Box box;
        bool coarse{false};
    };

    TreeValidator(const Tree& tree, std::span<const ChangedFace> faces) : tree_(tree)
    {
        for (const ChangedFace& face : faces)
        {
            faces_[face.prim.value] = &face;
        }
    }

    template <typename... Parts>
    void fault(const Parts&... parts)
    {
        std::ostringstream text;
        (text << ... << parts);
        faults_.push_back(text.str());
    }
    template <typename... Parts>
    void check(bool holds, const Parts&... parts)
    {
        if (!holds)
        {
            fault(parts...);
        }
    }

    void walk_all()
    {
        if (!tree_.root().is_none())
        {
            walk(tree_.root(), kNoNode, 0, 64);
        }
        check_unplaced();
        check(blocks_seen_ == tree_.blocks_used(), "blocks_used ", tree_.blocks_used(), ", found ",
              blocks_seen_);
        check(nodes_seen_ == tree_.nodes_used(), "nodes_used ", tree_.nodes_used(), ", found ",
              nodes_seen_);
    }

    /// Each face is either reached once or in the list of those without a place.
    void check_unplaced()
    {
        std::set<std::uint32_t> unplaced;
        for (const auto& [prim, face] : faces_)
        {
            if (tree_.is_unplaced({prim}))
            {
                unplaced.insert(prim);
                check(tree_.leaf_of({prim}) == Tree::kNoLeaf, "unplaced prim ", prim,
                      " has a leaf");
            }
        }
        check(tree_.is_complete() == unplaced.empty(), "is_complete is wrong");
        for (const auto& [prim, face] : faces_)
        {
            check(seen_.count(prim) + unplaced.count(prim) == 1, "prim ", prim, " is in ",
                  seen_.count(prim), " leaves and ", unplaced.count(prim), " times unplaced");
            check(tree_.face_of({prim}) == face->face, "prim ", prim, " has another face");
        }
    }

    Subtree walk(TreeRef ref, std::uint32_t parent, std::uint32_t child, std::uint32_t shift_above)
    {
        check(tree_.status(ref) == NodeStatus::active, "status of ", name(ref), " is not active");
        return ref.is_block() ? walk_block(ref.index(), parent, child)
                              : walk_node(ref.index(), parent, child, shift_above);
    }

    Subtree walk_node(std::uint32_t index, std::uint32_t parent, std::uint32_t child,
                      std::uint32_t shift_above)
    {
        ++nodes_seen_;
        const Node& node = tree_.node(index);
        check(node.parent == parent, "node ", index, " has parent ", node.parent, ", not ", parent);
        check(parent == kNoNode || node.child == child, "node ", index, " has a wrong child place");
        check(node.shift % 3 == 0 && node.shift < shift_above, "node ", index, " has shift ",
              int{node.shift}, " below ", shift_above);
        check(node.child_count() >= 2, "node ", index, " has ", node.child_count(), " children");
        check_digits(index, node);
        Subtree subtree;
        for (std::uint32_t i = 0; i < kNodeChildren; ++i)
        {
            const bool used = ((node.mask >> i) & 1U) != 0;
            check(used == !node.children[i].is_none(), "node ", index, " child ", i,
                  " contradicts the mask");
            if (!used)
            {
                check(((node.coarse >> i) & 1U) == 0, "node ", index, " child ", i,
                      " is coarse and not there");
                continue;
            }
            path_.push_back({index, i});
            const Subtree below = walk(node.children[i], index, i, node.shift);
            path_.pop_back();
            check(node.box_of(i) == below.box, "node ", index, " child ", i, " has another box");
            check((((node.coarse >> i) & 1U) != 0) == below.coarse, "node ", index, " child ", i,
                  " has a wrong coarse bit");
            subtree.coarse = subtree.coarse || below.coarse;
            Oracle::unite(subtree.box, below.box);
        }
        return subtree;
    }

    /// Each child has one aligned range, a power of two wide; a node's is one digit.
    void check_digits(std::uint32_t index, const Node& node)
    {
        std::array<std::vector<std::uint32_t>, kNodeChildren> digits;
        for (std::uint32_t digit = 0; digit < kNodeChildren; ++digit)
        {
            const std::uint32_t child = node.child_of(digit);
            if (child == Node::kNoChild)
            {
                continue;
            }
            if (child > Node::kNoChild || ((node.mask >> child) & 1U) == 0)
            {
                fault("node ", index, " digit ", digit, " leads to absent child ", child);
                continue;
            }
            digits[child].push_back(digit);
        }
        for (std::uint32_t child = 0; child < kNodeChildren; ++child)
        {
            if (((node.mask >> child) & 1U) == 0)
            {
                continue;
            }
            const auto& own = digits[child];
            const auto width = static_cast<std::uint32_t>(own.size());
            const bool is_cell = !own.empty() && std::has_single_bit(width) &&
                                 own.front() % width == 0 && own.back() == own.front() + width - 1;
            check(is_cell && width < kNodeChildren, "node ", index, " child ", child,
                  " has no aligned cell of digits");
            check(node.children[child].is_block() || width == 1, "node ", index, " child node ",
                  child, " has more than one digit");
        }
    }

    Subtree walk_block(std::uint32_t index, std::uint32_t parent, std::uint32_t child)
    {
        ++blocks_seen_;
        const BlockGeometry& block = tree_.block(index);
        const BlockSide& side = tree_.side(index);
        check(side.parent == parent, "block ", index, " has parent ", side.parent);
        check(parent == kNoNode || side.child == child, "block ", index,
              " has a wrong child place");
        check(block.faces != 0, "block ", index, " is empty");
        Subtree subtree;
        std::uint32_t used_rows = 0;
        std::uint32_t coarse = 0;
        ErrorCode largest = 0;
        for (std::uint32_t lane = 0; lane < kBlockFaces; ++lane)
        {
            if (((block.faces >> lane) & 1U) == 0)
            {
                continue;
            }
            for (std::size_t corner = 0; corner < 3; ++corner)
            {
                used_rows |= 1U << block.corners[corner][lane];
            }
            coarse |= side.errors[lane] != 0 ? 1U << lane : 0U;
            largest = std::max(largest, side.errors[lane]);
            check_lane(index, lane, subtree.box);
        }
        check(block.vertices == used_rows, "block ", index, " keeps vertices that no face uses");
        check(side.coarse == coarse, "block ", index, " has wrong coarse bits");
        subtree.coarse = coarse != 0;
        if (largest != 0)
        {
            subtree.box =
                Oracle::grown(subtree.box, static_cast<long double>(error_in_quanta(largest)) *
                                               static_cast<long double>(tree_.quantum_m()));
        }
        return subtree;
    }

    void check_lane(std::uint32_t index, std::uint32_t lane, Box& box)
    {
        const BlockSide& side = tree_.side(index);
        const std::uint32_t prim = side.prims[lane].value;
        const auto found = faces_.find(prim);
        if (found == faces_.end())
        {
            fault("block ", index, " lane ", lane, " holds prim ", prim, " that is gone");
            return;
        }
        const ChangedFace& face = *found->second;
        check(seen_.insert(prim).second, "prim ", prim, " is in two lanes");
        check(tree_.leaf_of({prim}) == index * kBlockFaces + lane, "prim ", prim,
              " has another leaf");
        check(side.errors[lane] == face.error, "prim ", prim, " has another error");
        const BlockGeometry& block = tree_.block(index);
        for (std::size_t corner = 0; corner < 3; ++corner)
        {
            const std::size_t row = block.corners[corner][lane];
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                const float at = face.corners_m[corner][axis];
                check(block.coordinates[axis][row] == at, "prim ", prim, " corner ", corner,
                      " has moved");
            }
            Oracle::widen(box, face.corners_m[corner]);
        }
        check_path(face);
    }

    /// The digits on the way down are those of the face's path.
    void check_path(const ChangedFace& face)
    {
        const std::uint64_t path = (std::uint64_t{face.bucket} << 33U) |
                                   (std::uint64_t{face.face.value * 0x9E37'79B9U} << 1U);
        for (const auto& [index, child] : path_)
        {
            const Node& node = tree_.node(index);
            check(node.holds(path), "face ", face.face.value, " is below foreign node ", index);
            check(node.child_of((path >> node.shift) & 7U) == child, "face ", face.face.value,
                  " is below a wrong child of node ", index);
        }
    }

    static std::string name(TreeRef ref)
    {
        return (ref.is_block() ? "block " : "node ") + std::to_string(ref.index());
    }

    struct Step
    {
        std::uint32_t node{0};
        std::uint32_t child{0};
    };

    const Tree& tree_;
    std::map<std::uint32_t, const ChangedFace*> faces_;
    std::set<std::uint32_t> seen_;
    std::vector<Step> path_;
    std::vector<std::string> faults_;
    std::uint32_t blocks_seen_{0};
    std::uint32_t nodes_seen_{0};
};

/// The first few faults as one text; empty when the tree is sound.
template <typename Tree>
[[nodiscard]] std::string tree_faults(const Tree& tree, std::span<const ChangedFace> faces)
{
    const std::vector<std::string> faults = TreeValidator<Tree>::faults(tree, faces);
    std::string text;
    for (std::size_t i = 0; i < std::min<std::size_t>(faults.size(), 8); ++i)
    {
        text += faults[i] + "\n";
    }
    return text;
}

} // namespace tactus::test
