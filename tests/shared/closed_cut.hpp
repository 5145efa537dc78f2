// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/replay.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::test
{

/// Cut of a file, refined from the base mesh in any order that the dependencies permit.
class ClosedCut
{
public:
    /// Starts at the base mesh. The model must be sound and outlive this object.
    explicit ClosedCut(const DecodedModel& model);

    /// Splits a record and its dependencies. Returns the split records in order, none if it was
    /// already split. Valid until the next call.
    std::span<const RecordId> split_with_closure(RecordId target);

    [[nodiscard]] bool is_split(RecordId record) const { return is_split_[record.value]; }
    [[nodiscard]] std::size_t split_count() const { return split_count_; }
    [[nodiscard]] const Replay& replay() const { return replay_; }

private:
    [[nodiscard]] RecordId missing_dependency(RecordId record) const;

    const DecodedModel& model_;
    Replay replay_;
    std::vector<bool> is_split_;
    std::size_t split_count_{0};
    std::vector<RecordId> open_;
    std::vector<RecordId> taken_;
};

} // namespace tactus::test
