// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/closed_cut.hpp"

#include <stdexcept>

namespace tactus::test
{

ClosedCut::ClosedCut(const DecodedModel& model)
    : model_(model), replay_(model), is_split_(model.header().counts().records)
{
}

std::span<const RecordId> ClosedCut::split_with_closure(RecordId target)
{
    taken_.clear();
    open_.push_back(target);
    while (!open_.empty())
    {
        const RecordId record = open_.back();
        if (const RecordId missing = missing_dependency(record); !missing.is_none())
        {
            open_.push_back(missing);
            continue;
        }
        open_.pop_back();
        if (is_split(record))
        {
            continue;
        }
        if (const auto fault = replay_.split(record))
        {
            throw std::logic_error(*fault);
        }
        is_split_[record.value] = true;
        ++split_count_;
        taken_.push_back(record);
    }
    return taken_;
}

RecordId ClosedCut::missing_dependency(RecordId record) const
{
    const VsplitRecord& fields = model_.record(record);
    for (std::uint32_t i = 0; i < fields.fan_size; ++i)
    {
        const FaceState before = fields.before[i];
        if (!before.is_base() && !is_split(before.record()))
        {
            return before.record();
        }
    }
    return {};
}

} // namespace tactus::test
