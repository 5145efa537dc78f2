// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/loaded_forest.hpp"

#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <utility>

namespace tactus::test
{

namespace
{

[[noreturn]] void give_up(RecordId record, const char* reason)
{
    std::fprintf(stderr, "loaded forest: record %u %s\n", record.value, reason);
    std::exit(2);
}

} // namespace

LoadedForest::LoadedForest(const TestModel& model) : rig_(model, with_room_for_all())
{
    load_everything(rig_);
}

std::uint32_t LoadedForest::split_with_dependencies(RecordId target)
{
    std::uint32_t splits = 0;
    std::vector<RecordId> stack{target};
    while (!stack.empty())
    {
        const RecordId id = stack.back();
        const VsplitRecord* record = pages().find_linked(id);
        if (record == nullptr)
        {
            give_up(id, "is not linked");
        }
        if (const RecordId missing = forest().missing_dependency(*record); !missing.is_none())
        {
            stack.push_back(missing);
            continue;
        }
        if (forest().split(id) != VertexForest::SplitOutcome::done)
        {
            give_up(id, "is not split although all that it depends on is");
        }
        stack.pop_back();
        ++splits;
    }
    return splits;
}

void LoadedForest::split_everything(Random& random)
{
    std::vector<std::uint32_t> order(counts().records);
    std::iota(order.begin(), order.end(), 0U);
    for (std::size_t i = order.size(); i > 1; --i)
    {
        std::swap(order[i - 1], order[random.below(i)]);
    }
    for (const std::uint32_t record : order)
    {
        if (!pages().is_refined({record}))
        {
            static_cast<void>(split_with_dependencies({record}));
        }
    }
}

std::uint32_t LoadedForest::merge_everything(Random& random)
{
    std::uint32_t merges = 0;
    for (bool any = true; any;)
    {
        any = false;
        const std::uint32_t shift = random_record(random).value;
        for (std::uint32_t i = 0; i < counts().records; ++i)
        {
            const RecordId record{(i + shift) % counts().records};
            if (pages().is_refined(record) && forest().try_merge(record))
            {
                any = true;
                ++merges;
            }
        }
    }
    return merges;
}

std::vector<PrimId> LoadedForest::active()
{
    std::vector<PrimId> prims;
    for (std::uint32_t i = 0; i < forest().capacity(); ++i)
    {
        if (!forest().face(PrimId{i}).id.is_none())
        {
            prims.push_back(PrimId{i});
        }
    }
    return prims;
}

} // namespace tactus::test
