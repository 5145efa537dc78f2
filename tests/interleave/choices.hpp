// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <vector>

namespace tactus::interleave
{

/// Depth-first walk of a tree of choices, one leaf a run. A run is deterministic except for
/// choose(): it is restarted for each leaf and repeats the old answers up to the next branch.
class Choices
{
public:
    /// Branch to take here, 0 .. count - 1.
    [[nodiscard]] std::size_t choose(std::size_t count)
    {
        if (depth_ == branches_.size())
        {
            branches_.push_back({0, count});
        }
        return branches_[depth_++].taken;
    }

    /// Advances to the next branch after a run; false if all were taken.
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
