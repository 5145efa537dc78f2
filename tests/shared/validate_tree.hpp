// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/validate_tree.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <vector>

namespace tactus::test
{

/// Compares a sound AB-Tree (find_flaw()) after refit() with its expected faces.
///
/// Boxes are recomputed bottom-up from the faces by separate arithmetic and must be equal bit for
/// bit: the tree equals one refitted from scratch (invariant I6).
class TreeOracle
{
public:
    /// Faults of a tree; `faces` are all that were added and not removed since.
    [[nodiscard]] static std::vector<std::string> faults(const AbTree& tree,
                                                         std::span<const ChangedFace> faces)
    {
        TreeOracle oracle(tree, faces);
        oracle.walk_all();
        return oracle.faults_;
    }

private:
    struct Subtree
    {
        Aabb box;
        bool coarse{false};
        bool exact{false};
    };

    TreeOracle(const AbTree& tree, std::span<const ChangedFace> faces) : tree_(tree)
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
            check(walk(tree_.root()).box == tree_.box(), "the root has another box");
        }
        check_unplaced();
    }

    /// Each face is reached once, or has no place.
    void check_unplaced()
    {
        std::size_t unplaced = 0;
        for (const auto& [prim, face] : faces_)
        {
            const bool is_unplaced = tree_.is_unplaced({prim});
            unplaced += is_unplaced ? 1 : 0;
            check(seen_.count(prim) + (is_unplaced ? 1 : 0) == 1, "prim ", prim, " is in ",
                  seen_.count(prim), " leaves and ", is_unplaced, " times unplaced");
            check(tree_.face_of({prim}) == face->face, "prim ", prim, " has another face");
        }
        check(tree_.is_complete() == (unplaced == 0), "is_complete is wrong");
    }

    Subtree walk(TreeRef ref)
    {
        return ref.is_block() ? walk_block(ref.index()) : walk_node(ref.index());
    }

    Subtree walk_node(std::uint32_t index)
    {
        const AbNode& node = tree_.node(index);
        Subtree subtree;
        for (std::uint32_t i = 0; i < kNodeChildren; ++i)
        {
            if (((node.mask >> i) & 1U) == 0)
            {
                continue;
            }
            path_.push_back({index, i});
            const Subtree below = walk(node.children[i]);
            path_.pop_back();
            check(node.box_of(i) == below.box, "node ", index, " child ", i, " has another box");
            check((((node.coarse >> i) & 1U) != 0) == below.coarse, "node ", index, " child ", i,
                  " has a wrong coarse bit");
            check((((node.exact >> i) & 1U) != 0) == below.exact, "node ", index, " child ", i,
                  " has a wrong exact bit");
            subtree.coarse = subtree.coarse || below.coarse;
            subtree.exact = subtree.exact || below.exact;
            unite(subtree.box, below.box);
        }
        return subtree;
    }

    Subtree walk_block(std::uint32_t index)
    {
        const BlockGeometry& block = tree_.block(index);
        const BlockSide& side = tree_.side(index);
        Subtree subtree;
        ErrorCode largest = 0;
        for (std::uint32_t lane = 0; lane < kBlockFaces; ++lane)
        {
            if (((block.faces >> lane) & 1U) != 0)
            {
                largest = std::max(largest, side.errors[lane]);
                subtree.exact = subtree.exact || side.errors[lane] == 0;
                check_lane(index, lane, subtree.box);
            }
        }
        subtree.coarse = largest != 0;
        if (largest != 0)
        {
            subtree.box = grown(subtree.box, static_cast<long double>(error_in_quanta(largest)) *
                                                 static_cast<long double>(tree_.quantum_m()));
        }
        return subtree;
    }

    void check_lane(std::uint32_t index, std::uint32_t lane, Aabb& box)
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
            unite(box, {face.corners_m[corner], face.corners_m[corner]});
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
            const AbNode& node = tree_.node(index);
            check(node.holds(path), "face ", face.face.value, " is below foreign node ", index);
            check(node.child_of((path >> node.shift) & 7U) == child, "face ", face.face.value,
                  " is below a wrong child of node ", index);
        }
    }

    static void unite(Aabb& box, const Aabb& other)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            box.low[axis] = std::min(box.low[axis], other.low[axis]);
            box.high[axis] = std::max(box.high[axis], other.high[axis]);
        }
    }

    /// Grows a box by the least float that is not below `error_m`, and rounds outwards.
    [[nodiscard]] static Aabb grown(Aabb box, long double error_m)
    {
        const auto margin = static_cast<long double>(float_above(error_m));
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            box.low[axis] = float_below(static_cast<long double>(box.low[axis]) - margin);
            box.high[axis] = float_above(static_cast<long double>(box.high[axis]) + margin);
        }
        return box;
    }
    [[nodiscard]] static float float_below(long double value)
    {
        const auto nearest = static_cast<float>(value);
        return static_cast<long double>(nearest) > value
                   ? std::nextafter(nearest, -std::numeric_limits<float>::infinity())
                   : nearest;
    }
    [[nodiscard]] static float float_above(long double value) { return -float_below(-value); }

    struct Step
    {
        std::uint32_t node{0};
        std::uint32_t child{0};
    };

    const AbTree& tree_;
    std::map<std::uint32_t, const ChangedFace*> faces_;
    std::set<std::uint32_t> seen_;
    std::vector<Step> path_;
    std::vector<std::string> faults_;
};

/// First few faults as one text; empty if the tree is sound and holds those faces.
[[nodiscard]] inline std::string tree_faults(const AbTree& tree, std::span<const ChangedFace> faces)
{
    if (const Flaw flaw = find_flaw(tree); !flaw.is_none())
    {
        return text_of(flaw).data();
    }
    const std::vector<std::string> faults = TreeOracle::faults(tree, faces);
    std::string text;
    for (std::size_t i = 0; i < std::min<std::size_t>(faults.size(), 8); ++i)
    {
        text += faults[i] + "\n";
    }
    return text;
}

} // namespace tactus::test
