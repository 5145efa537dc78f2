// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <vector>

namespace tactus::interleave
{

/// Walks a tree of choices depth first, one leaf a run. A run is deterministic but for choose(): it
/// is started from the beginning for each leaf and gets the old answers up to the place where it
/// takes another branch.
class Choices
{
public:
    /// The branch to take here, 0 .. count - 1.
    [[nodiscard]] std::size_t choose(std::size_t count)
    {
        if (depth_ == branches_.size())
        {
            branches_.push_back({0, count});
        }
        return branches_[depth_++].taken;
    }

    /// After a run: makes the next one take the next branch; false when all were taken.
    [[nodiscard]] bool try_advance()
    {
        depth_ = 0;
        while (!branches_.empty() && branches_.back().taken + 1 == branches_.back().count)
        {
            branches_.pop_back();
        }
        if (branches_.empty())
        {
            return false;
        }
        ++branches_.back().taken;
        return true;
    }

private:
    struct Branch
    {
        std::size_t taken{0};
        std::size_t count{1};
    };

    std::vector<Branch> branches_;
    std::size_t depth_{0}; ///< Choices of this run so far.
};

} // namespace tactus::interleave
