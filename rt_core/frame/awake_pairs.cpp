// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/awake_pairs.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/base/small_sort.hpp"
#include "rt_core/frame/model_set.hpp"

#include <algorithm>
#include <tuple>

namespace tactus
{

namespace
{

[[nodiscard]] std::pair<std::uint32_t, std::uint32_t> place_of(const PairParts& parts) noexcept
{
    return {parts.tool_index, parts.object_number};
}

} // namespace

AwakePairs::AwakePairs(Arena& arena, std::span<const ToolSpec> tools, std::uint32_t most) noexcept
    : pairs_(arena.take<Pair>(most)), memory_(PairMemory::take(arena, tools, most))
{
    for (std::uint32_t i = most; i > 0; --i)
    {
        free_.push_back(i - 1);
    }
    if (arena.is_measuring())
    {
        return; // Its spans have no memory.
    }
    for (PairFront& front : memory_.fronts) // NOLINT(misc-const-correctness): it is lent.
    {
        free_fronts_.push_back(&front);
    }
}

void AwakePairs::order() noexcept
{
    order_ = awake_;
    sort_without_recursion(order_,
                           [](const Pair* a, const Pair* b)
                           {
                               return a->priority() == b->priority()
                                          ? place_of(a->parts()) < place_of(b->parts())
                                          : a->priority() < b->priority();
                           });
    lend_fronts();
}

/// Lends fronts to the highest-priority pairs of mesh tools, and takes them back from others. A
/// newly lent front is empty.
void AwakePairs::lend_fronts() noexcept
{
    StaticVector<Pair*, PairFront::kFronts> first;
    for (Pair* pair : order_)
    {
        if (pair->is_of_mesh() &&
            (first.size() == memory_.fronts.size() || !first.try_push_back(pair)))
        {
            take_back_front(*pair);
        }
    }
    for (Pair* pair : first)
    {
        PairFront* front = pair->exchange_front(nullptr);
        if (front == nullptr)
        {
            front = free_fronts_.pop_back();
            front->count = 0;
            front->pause = 0;
        }
        pair->exchange_front(front);
    }
}

void AwakePairs::take_back_front(Pair& pair) noexcept
{
    // NOLINTNEXTLINE(misc-const-correctness): it is lent again.
    PairFront* const front = pair.exchange_front(nullptr);
    if (front != nullptr)
    {
        free_fronts_.push_back(front);
    }
}

void AwakePairs::begin(const PairParts& parts) noexcept
{
    const std::uint32_t slot = free_.pop_back();
    pairs_[slot] = Pair(parts, memory_, slot);
    const auto at = std::ranges::find_if(awake_, [&parts](const Pair* pair)
                                         { return place_of(parts) < place_of(pair->parts()); }) -
                    awake_.begin();
    // A tool has one pair with an object.
    TACTUS_ASSERT(at == 0 || place_of(awake_.begin()[at - 1]->parts()) != place_of(parts));
    awake_.push_back(&pairs_[slot]);
    std::rotate(awake_.begin() + at, awake_.end() - 1, awake_.end());
    for (std::uint32_t i = parts.tool_index + 1; i < first_of_tool_.size(); ++i)
    {
        ++first_of_tool_[i];
    }
}

void AwakePairs::end(Pair& pair, ModelSet& models) noexcept
{
    const PairParts& parts = pair.parts();
    models[parts.model.id].refiner.release(pair.object_closure());
    if (parts.tool_model.model != nullptr)
    {
        models[parts.tool_model.id].refiner.release(pair.tool_closure());
    }
    const auto slot = static_cast<std::uint32_t>(&pair - pairs_.data());
    TACTUS_ASSERT(slot < pairs_.size());
    free_.push_back(slot);
    if (pair.is_of_mesh())
    {
        take_back_front(pair);
    }
    auto* const at = std::ranges::find(awake_, &pair);
    TACTUS_ASSERT(at != awake_.end());
    std::move(at + 1, awake_.end(), at);
    (void)awake_.pop_back();
    for (std::uint32_t i = pair.tool() + 1; i < first_of_tool_.size(); ++i)
    {
        --first_of_tool_[i];
    }
}

void AwakePairs::report() noexcept
{
    for (std::size_t i = 0; i < awake_.size(); ++i)
    {
        outputs_[i] = awake_[i]->output();
        awake_[i]->remember();
    }
}

} // namespace tactus
