// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/model_set.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/frame/validate_model.hpp"

#include <algorithm>

namespace tactus
{

void ModelSet::add(std::uint32_t frame) noexcept
{
    TACTUS_ASSERT(count_ < slots_.size());
    TACTUS_ASSERT(slots_[count_].model.has_value());
    wake({count_++}, frame);
}

void ModelSet::wake(ModelId id, std::uint32_t frame) noexcept
{
    TACTUS_ASSERT(id.value < count_);
    slots_[id.value].paired_frame = frame;
    keep_busy(id);
}

void ModelSet::keep_busy(ModelId id) noexcept
{
    ModelSlot& slot = slots_[id.value];
    if (!slot.is_busy)
    {
        slot.is_busy = true;
        busy_.push_back(id);
        const auto is_before = [](ModelId a, ModelId b) { return a.value < b.value; };
        auto* const at = std::lower_bound(busy_.begin(), busy_.end() - 1, id, is_before);
        std::rotate(at, busy_.end() - 1, busy_.end());
    }
}

void ModelSet::let_rest(std::uint32_t frame) noexcept
{
    std::uint32_t left = 0;
    for (const ModelId id : busy_)
    {
        ModelSlot& slot = slots_[id.value];
        slot.is_busy = slot.paired_frame == frame || !slot.model->is_at_rest();
        busy_[left] = id;
        left += slot.is_busy ? 1 : 0;
    }
    while (busy_.size() > left)
    {
        (void)busy_.pop_back();
    }
}

void ModelSet::refit(bool all, WorkCounters& work, FrameFault& faults) noexcept
{
    std::uint32_t boxes = 0;
    for (const ModelId id : busy_)
    {
        Model& model = *slots_[id.value].model;
        if (all)
        {
            model.tree.mark_all();
        }
        boxes += model.tree.blocks_used() + model.tree.nodes_used();
        model.refit(work, faults);
    }
    const std::uint32_t refitted = work.blocks_refitted + work.nodes_refitted;
    work.skipped.add(Skip::boxes, boxes - std::min(boxes, refitted));
}

void ModelSet::report() noexcept
{
    for (const ModelId id : busy_)
    {
        const Model& model = *slots_[id.value].model;
        validate(model);
        outputs_[id.value] = model.output();
    }
}

} // namespace tactus
