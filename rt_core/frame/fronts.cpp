// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/fronts.hpp"

namespace tactus
{

namespace
{

/// Calls `take(id, record)` for each linked record of each adopted page.
template <typename Take>
void for_each_loaded(const Model& model, const Take& take) noexcept
{
    const std::uint32_t records = model.header.counts().records;
    for (std::uint32_t slot = 0; slot < model.pages.capacity(); ++slot)
    {
        if (!model.pages.is_own(slot))
        {
            continue;
        }
        const ChunkId chunk = model.pages.meta(slot).chunk;
        const std::uint32_t first = chunk.value << kRecordsPerChunkLog2;
        for (std::uint32_t i = first; i < records && i < first + kRecordsPerChunk; ++i)
        {
            if (const VsplitRecord* record = model.pages.find_linked({i}); record != nullptr)
            {
                take(RecordId{i}, *record);
            }
        }
    }
}

RegionId region_of(const Model& model, const VsplitRecord& record) noexcept
{
    const Vec3 vertex = to_vec3(record.position_m);
    return model.header.region_at({vertex.x(), vertex.y(), vertex.z()});
}

template <typename Wanted>
std::uint32_t list_where(const Model& model, std::span<RecordId> out, const Wanted& wanted) noexcept
{
    std::uint32_t found = 0;
    for_each_loaded(model,
                    [&](RecordId id, const VsplitRecord& record)
                    {
                        if (!wanted(id, record))
                        {
                            return;
                        }
                        if (found < out.size())
                        {
                            out[found] = id;
                        }
                        ++found;
                    });
    return found;
}

} // namespace

FrontCount count_fronts(const Model& model) noexcept
{
    FrontCount count;
    for_each_loaded(model,
                    [&](RecordId id, const VsplitRecord&)
                    {
                        ++count.loaded;
                        count.refined += model.pages.is_refined(id) ? 1U : 0U;
                    });
    return count;
}

FrontCount count_fronts(const Model& model, RegionId region) noexcept
{
    return {list_loaded_front(model, region, {}), list_refined_front(model, region, {})};
}

std::uint32_t list_refined_front(const Model& model, RegionId region,
                                 std::span<RecordId> out) noexcept
{
    return list_where(model, out,
                      [&](RecordId id, const VsplitRecord& record)
                      { return model.pages.is_refined(id) && region_of(model, record) == region; });
}

std::uint32_t list_loaded_front(const Model& model, RegionId region,
                                std::span<RecordId> out) noexcept
{
    return list_where(model, out,
                      [&](RecordId, const VsplitRecord& record)
                      { return region_of(model, record) == region; });
}

} // namespace tactus
